#include "engine/track/near_loops.hpp"

#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <optional>

namespace lacuna {
namespace {

using CellOfLattice = std::array<double, 3>;  // whole numbers

// A cell that is near a loop, or one of its own.
struct LoopCell {
  CellOfLattice cell;
  std::uint32_t loop;
  std::uint32_t is_own;

  friend auto operator<=>(const LoopCell&, const LoopCell&) = default;
};

// A cell of loop a that is near loop b.
struct SharedCell {
  std::uint32_t a, b;

  friend auto operator<=>(const SharedCell&, const SharedCell&) = default;
};

using CellSort = SortedRuns<LoopCell>;
using SharedSort = SortedRuns<SharedCell>;

// visit(cell) for each cell that the closed loop passes through at steps of at most an edge; some several times.
template <class Visit>
void draw(const PlacedLoops& loops, std::size_t loop, double edge, Visit&& visit) {
  std::optional<CellOfLattice> last;
  const auto pass = [&](const Eigen::Vector3d& p) {
    const CellOfLattice cell{std::floor(p.x() / edge), std::floor(p.y() / edge), std::floor(p.z() / edge)};
    if (last != cell) visit(cell);
    last = cell;
  };
  std::optional<Eigen::Vector3d> first, before;
  const auto go_to = [&](const Eigen::Vector3d& to) {
    const Eigen::Vector3d way = to - *before;
    const double steps = std::ceil(way.norm() / edge);
    for (double step = 1; step < steps; ++step) pass(*before + way * (step / steps));
    pass(to);
    before = to;
  };
  loops.for_each_point(loop, [&](const StoredLoopPoint& p) {
    const Eigen::Vector3d position = p.point.position();
    if (first) {
      go_to(position);
    } else {
      first = before = position;
      pass(position);
    }
  });
  go_to(*first);
}

void add_cells(const LevelLoops& level, std::uint32_t first, double edge, CellSort& cells) {
  for (std::size_t i = 0; i < level.loops.size(); ++i) {
    const auto loop = first + static_cast<std::uint32_t>(i);
    draw(level.loops, i, edge, [&](const CellOfLattice& cell) {
      cells.add({cell, loop, 1});
      for (const double x : {-1, 0, 1}) {
        for (const double y : {-1, 0, 1}) {
          for (const double z : {-1, 0, 1}) cells.add({{cell[0] + x, cell[1] + y, cell[2] + z}, loop, 0});
        }
      }
    });
  }
}

// The loops at one cell after the other. Counts the cells of each loop.
void add_shared(CellSort& cells, std::uint32_t first_coarse, std::vector<std::uint32_t>& own_cells,
                SharedSort& shared) {
  std::vector<std::uint32_t> own, near;  // loops at this cell, ascending
  const auto add = [&] {
    for (const std::uint32_t a : own) {
      ++own_cells[a];
      for (const std::uint32_t b : near) {
        if (a != b && std::max(a, b) >= first_coarse) shared.add({a, b});
      }
    }
    own.clear();
    near.clear();
  };
  std::optional<LoopCell> last;
  cells.for_each([&](const LoopCell& c) {
    if (last && last->cell != c.cell) add();
    if (!last || *last != c) (c.is_own ? own : near).push_back(c.loop);
    last = c;
  });
  add();
}

// Both directions of a pair are wanted at a time, so pairs are sorted again by their lower loop.
void add_pairs(SharedSort& shared, const std::vector<std::uint32_t>& own_cells, std::vector<NearLoops>& pairs) {
  const std::size_t begin = pairs.size();
  std::optional<SharedCell> last;
  std::uint32_t count = 0;
  const auto add = [&] {
    if (!last || 2 * std::uint64_t{count} < own_cells[last->a]) return;
    const float share = static_cast<float>(count) / static_cast<float>(own_cells[last->a]);
    if (last->a < last->b)
      pairs.push_back({last->a, last->b, share, 0});
    else
      pairs.push_back({last->b, last->a, 0, share});
  };
  shared.for_each([&](const SharedCell& s) {
    if (last != s) {
      add();
      count = 0;
    }
    last = s;
    ++count;
  });
  add();
  std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(begin), pairs.end(),
            [](const NearLoops& x, const NearLoops& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  std::size_t kept = begin;
  for (std::size_t i = begin; i < pairs.size(); ++i) {
    if (kept > begin && pairs[kept - 1].a == pairs[i].a && pairs[kept - 1].b == pairs[i].b) {
      pairs[kept - 1].of_a += pairs[i].of_a;
      pairs[kept - 1].of_b += pairs[i].of_b;
    } else {
      pairs[kept++] = pairs[i];
    }
  }
  pairs.resize(kept);
}

}  // namespace

std::vector<NearLoops> near_loops(std::span<const LevelLoops> levels, const Job& job) {
  std::vector<NearLoops> pairs;
  std::vector<std::uint32_t> first = {0};
  for (const LevelLoops& level : levels)
    first.push_back(first.back() + static_cast<std::uint32_t>(level.loops.size()));
  for (std::size_t coarse = 0; coarse < levels.size(); ++coarse) {
    CellSort cells(job.file("loop-cells"), job.memory.global / 4);
    for (std::size_t l = coarse - std::min(coarse, kBridged + 1); l <= coarse; ++l)
      add_cells(levels[l], first[l], levels[coarse].cell_edge, cells);
    std::vector<std::uint32_t> own_cells(first.back());
    SharedSort shared(job.file("shared-cells"), job.memory.global / 4);
    add_shared(cells, first[coarse], own_cells, shared);
    add_pairs(shared, own_cells, pairs);
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const NearLoops& x, const NearLoops& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  return pairs;
}

}  // namespace lacuna
