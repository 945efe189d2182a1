// SPDX-License-Identifier: Apache-2.0
#include "engine/track/track_loops.hpp"

#include "engine/loops/confidence.hpp"
#include "engine/model/nanoflann_tree.hpp"
#include "engine/store/column.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <filesystem>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace lacuna {

// ---- Which loops run along each other

namespace {

using CellOfLattice = std::array<double, 3>;  // whole numbers

// A cell that a loop passes through.
struct LoopCell {
  CellOfLattice cell;
  std::uint64_t loop;

  friend auto operator<=>(const LoopCell&, const LoopCell&) = default;
};

// A cell of loop a that is near loop b.
struct SharedCell {
  std::uint32_t a, b;

  friend auto operator<=>(const SharedCell&, const SharedCell&) = default;
};

using CellSort = SortedRuns<LoopCell>;
using SharedSort = SortedRuns<SharedCell>;

// An edge of a loop is drawn in at most this many steps: to a far outlier it may be as long as the scan.
constexpr double kMostSteps = 16;

// Calls visit(cell) for each cell that the closed loop passes through at steps of an edge or less. Some cells
// are visited several times.
template <class Visit>
void draw(const Loops& loops, std::size_t loop, double edge, Visit&& visit) {
  std::optional<CellOfLattice> last;
  const auto pass = [&](const Eigen::Vector3d& p) {
    const CellOfLattice cell{std::floor(p.x() / edge), std::floor(p.y() / edge), std::floor(p.z() / edge)};
    if (last != cell) visit(cell);
    last = cell;
  };
  std::optional<Eigen::Vector3d> first, before;
  const auto go_to = [&](const Eigen::Vector3d& to) {
    const Eigen::Vector3d way = to - *before;
    const double steps = std::min(std::ceil(way.norm() / edge), kMostSteps);
    for (double step = 1; step < steps; ++step) pass(*before + way * (step / steps));
    pass(to);
    before = to;
  };
  loops.for_each_point(loop, [&](const LoopPoint& p) {
    const Eigen::Vector3d position = p.position();
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
    if (!could_be_tracked(level.loops.evidence(i))) continue;
    draw(level.loops, i, edge, [&](const CellOfLattice& cell) { cells.add({cell, first + i}); });
  }
}

// Returns all cells of all loops, each once, in order.
Column<LoopCell> sorted_cells(CellSort& cells, std::filesystem::path path) {
  Column<LoopCell> sorted(std::move(path));
  ColumnWriter<LoopCell> writer(sorted);
  std::optional<LoopCell> last;
  cells.for_each([&](const LoopCell& c) {
    if (last != c) writer.add(c);
    last = c;
  });
  writer.finish();
  return sorted;
}

// The cells of one row of the lattice, at a fixed offset from the current cell. The row moves on as the
// current cell does.
class RowOfCells {
 public:
  RowOfCells(const Column<LoopCell>& cells, double x, double y)
      : cells_(cells), size_(cells.size()), x_(x), y_(y) {}

  // Calls visit(loop) for each loop that passes through one of the three cells in this row.
  template <class Visit>
  void for_each_near(const CellOfLattice& at, Visit&& visit) {
    const CellOfLattice low{at[0] + x_, at[1] + y_, at[2] - 1}, high{low[0], low[1], at[2] + 1};
    while (next_ < size_ && cells_[next_].cell < low) ++next_;
    for (std::uint64_t i = next_; i < size_ && cells_[i].cell <= high; ++i)
      visit(static_cast<std::uint32_t>(cells_[i].loop));
  }

 private:
  ColumnReader<LoopCell> cells_;
  std::uint64_t size_;
  std::uint64_t next_ = 0;
  double x_, y_;
};

// Goes along the cells in order, with the nine rows around. It counts the cells of each loop. A pair counts
// where one of its loops belongs to the coarse level.
void add_shared(const Column<LoopCell>& cells, std::uint32_t first_coarse,
                std::vector<std::uint32_t>& own_cells, SharedSort& shared) {
  std::vector<RowOfCells> rows;
  for (const double x : {-1, 0, 1}) {
    for (const double y : {-1, 0, 1}) rows.emplace_back(cells, x, y);
  }
  ColumnReader<LoopCell> reader(cells);
  std::vector<std::uint32_t> near;
  std::optional<CellOfLattice> last;
  for (std::uint64_t i = 0; i < cells.size(); ++i) {
    const LoopCell at = reader[i];
    if (last != at.cell) {
      near.clear();
      for (RowOfCells& row : rows)
        row.for_each_near(at.cell, [&](std::uint32_t loop) { near.push_back(loop); });
      std::sort(near.begin(), near.end());
      near.erase(std::unique(near.begin(), near.end()), near.end());
      last = at.cell;
    }
    const auto a = static_cast<std::uint32_t>(at.loop);
    ++own_cells[a];
    for (const std::uint32_t b : near) {
      if (a != b && std::max(a, b) >= first_coarse) shared.add({a, b});
    }
  }
}

// Both directions of a pair are wanted at a time, so pairs are sorted again by their lower loop.
std::vector<NearLoops> pairs_of(SharedSort& shared, const std::vector<std::uint32_t>& own_cells) {
  std::vector<NearLoops> pairs;
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
  std::sort(pairs.begin(), pairs.end());
  std::size_t kept = 0;
  for (const NearLoops& pair : pairs) {
    if (kept > 0 && pairs[kept - 1].a == pair.a && pairs[kept - 1].b == pair.b) {
      pairs[kept - 1].of_a += pair.of_a;
      pairs[kept - 1].of_b += pair.of_b;
    } else {
      pairs[kept++] = pair;
    }
  }
  pairs.resize(kept);
  return pairs;
}

}  // namespace

std::vector<NearLoops> near_loops(std::span<const LevelLoops> levels, const Spill& spill,
                                  const Workers& workers) {
  std::vector<std::uint32_t> first = {0};
  for (const LevelLoops& level : levels)
    first.push_back(first.back() + static_cast<std::uint32_t>(level.loops.size()));
  const MemoryLedger::Lease sorting = workers.memory.ledger.take(workers.memory.work / 2);
  const std::uint64_t budget = sorting.bytes() / 2 / std::min(workers.arena.threads(), levels.size());
  std::vector<std::vector<NearLoops>> pairs(levels.size());  // by the coarser level
  workers.arena.for_each(levels.size(), [&](std::size_t coarse) {
    const auto file = [&](const char* name) { return spill.file(name + std::to_string(coarse)); };
    CellSort cells(file("loop-cells-"), budget);
    for (std::size_t l = coarse - std::min(coarse, kBridged + 1); l <= coarse; ++l)
      add_cells(levels[l], first[l], levels[coarse].cell_edge, cells);
    std::vector<std::uint32_t> own_cells(first.back());
    SharedSort shared(file("shared-cells-"), budget);
    add_shared(sorted_cells(cells, file("sorted-loop-cells-")), first[coarse], own_cells, shared);
    pairs[coarse] = pairs_of(shared, own_cells);
  });
  std::vector<NearLoops> all;
  for (const std::vector<NearLoops>& of_level : pairs)
    all.insert(all.end(), of_level.begin(), of_level.end());
  std::sort(all.begin(), all.end());
  return all;
}

// ---- Which of them are chosen

namespace {

// A loop of any level, and the levels of its track.
struct TrackedLoop {
  std::uint32_t level, loop;  // the number within the level
  std::uint32_t first, last;
  std::uint32_t first_of_kind;  // of the track that has the loops of its own kind alone
  LoopEvidence evidence;
  double log_odds = 0;
};

// Returns all loops as `near_loops` numbers them, each with a track of its own.
std::vector<TrackedLoop> loops_of(std::span<const LevelLoops> levels) {
  std::vector<TrackedLoop> loops;
  for (std::uint32_t l = 0; l < levels.size(); ++l) {
    for (std::uint32_t i = 0; i < levels[l].loops.size(); ++i)
      loops.push_back({l, i, l, l, l, levels[l].loops.evidence(i)});
  }
  return loops;
}

// Follows each hole up to its last level, and down to its first one. Pairs and their levels ascend, so each
// way takes one pass.
void follow(std::span<const NearLoops> pairs, std::vector<TrackedLoop>& loops) {
  std::vector<NearLoops> links;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(links),
               [&](const NearLoops& p) { return p.is_same_hole() && loops[p.a].level != loops[p.b].level; });
  for (std::size_t i = links.size(); i-- > 0;)
    loops[links[i].a].last = std::max(loops[links[i].a].last, loops[links[i].b].last);
  std::sort(links.begin(), links.end(),
            [](const NearLoops& x, const NearLoops& y) { return x.b != y.b ? x.b < y.b : x.a < y.a; });
  for (const NearLoops& link : links) {
    const TrackedLoop& from = loops[link.a];
    TrackedLoop& to = loops[link.b];
    to.first = std::min(to.first, from.first);
    if (to.evidence.kind == from.evidence.kind)
      to.first_of_kind = std::min(to.first_of_kind, from.first_of_kind);
  }
}

// Adds the persistence to the evidence: 0 where the track ends at all points, or before the spacing.
void rate(std::span<const LevelLoops> levels, std::vector<TrackedLoop>& loops) {
  for (TrackedLoop& loop : loops) {
    const double spacing = loop.evidence.spacing, edge = levels[loop.last].edge;
    if (edge > spacing) loop.evidence.persistence = octaves(edge / spacing);
    loop.log_odds = log_odds(loop.evidence);
  }
}

// By loop: the loops of the highest rank are chosen first.
std::vector<double> ranks_of(std::span<const TrackedLoop> loops) {
  constexpr double kSure = 4;                 // log-odds from which on loops are equally good
  constexpr double kLevelCost = 0.8;          // of a level, in log-odds: fine curves are closer to the hole
  constexpr std::uint64_t kUsuallyAlike = 7;  // they are counted among the loops that stand, so later
  std::vector<double> ranks;
  for (const TrackedLoop& loop : loops) {
    LoopEvidence usual = loop.evidence;
    usual.alike = kUsuallyAlike;
    const double level = loop.level + 0.5 * loop.evidence.is_coarse;
    ranks.push_back(std::min(log_odds(usual), kSure) - kLevelCost * level);
  }
  return ranks;
}

// Goes down from the highest rank. A loop is chosen unless a chosen loop is at the same place. At the same
// place are loops that run along half of it, and loops that run along loops of the same hole. A coarse
// cell may hold an opening and the curve around it. So a loop of the other kind that begins at its level, or
// a finer one, is a curve of its own.
std::vector<std::uint32_t> choose(std::span<const NearLoops> pairs, std::span<const TrackedLoop> loops) {
  const std::vector<double> ranks = ranks_of(loops);
  struct Neighbour {
    std::uint32_t loop;
    bool is_same;
  };
  std::vector<std::uint32_t> begin(ranks.size() + 1);
  for (const NearLoops& p : pairs) ++begin[p.a + 1], ++begin[p.b + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Neighbour> neighbours(2 * pairs.size());
  std::vector<std::uint32_t> end(begin.begin(), begin.end() - 1);
  for (const NearLoops& p : pairs) {
    neighbours[end[p.a]++] = {p.b, p.is_same_hole()};
    neighbours[end[p.b]++] = {p.a, p.is_same_hole()};
  }

  std::vector<std::uint32_t> order(ranks.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
    return ranks[x] != ranks[y] ? ranks[x] > ranks[y] : x < y;
  });
  constexpr std::uint32_t kNone = UINT32_MAX;
  enum class Standing : std::uint8_t { kOpen, kChosen, kCovered };
  std::vector<Standing> standing(ranks.size(), Standing::kOpen);
  std::vector<std::uint32_t> chosen, place, reached_by(ranks.size(), kNone);
  for (const std::uint32_t loop : order) {
    if (standing[loop] != Standing::kOpen) continue;
    standing[loop] = Standing::kChosen;
    chosen.push_back(loop);
    place.assign(1, loop);
    while (!place.empty()) {
      const std::uint32_t at = place.back();
      place.pop_back();
      for (std::uint32_t n = begin[at]; n < begin[at + 1]; ++n) {
        const auto& [other, is_same] = neighbours[n];
        if (standing[other] == Standing::kChosen) continue;
        if (at != loop && loops[other].evidence.kind != loops[loop].evidence.kind &&
            loops[other].first_of_kind <= loops[loop].level)
          continue;
        if (std::exchange(reached_by[other], loop) == loop) continue;
        standing[other] = Standing::kCovered;
        if (is_same) place.push_back(other);
      }
    }
  }
  return chosen;
}

// Counts for each probable outer curve the others that stand and are alike: half to twice as large, and near.
// One among its like is a pattern of the sampling. Curves are in trees by the octave of their size.
void count_alike(std::span<const std::uint32_t> chosen, double min_confidence,
                 std::vector<TrackedLoop>& loops) {
  constexpr double kNear = 12;  // distance of the middles, in radii
  struct OfSize {
    std::vector<std::uint32_t> loops;
    std::vector<Eigen::Vector3d> middles;
  };
  std::map<int, OfSize> by_size;
  for (const std::uint32_t loop : chosen) {
    const LoopEvidence& e = loops[loop].evidence;
    if (e.kind != LoopKind::kOuter || !(e.radius > 0) || !std::isfinite(e.radius)) continue;
    OfSize& of_size = by_size[std::ilogb(e.radius)];
    of_size.loops.push_back(loop);
    of_size.middles.emplace_back(e.middle[0], e.middle[1], e.middle[2]);
  }
  std::vector<std::pair<std::uint32_t, double>> near;  // with squared distances
  for (const auto& [size, others] : by_size) {
    const NanoflannTree<std::uint32_t> tree(others.middles);
    for (auto of = by_size.lower_bound(size - 1); of != by_size.upper_bound(size + 1); ++of) {
      for (const std::uint32_t i : of->second.loops) {
        TrackedLoop& loop = loops[i];
        if (probability_of(loop.log_odds) < min_confidence) continue;
        const double radius = loop.evidence.radius, reach = kNear * radius;
        tree.index.radiusSearch(loop.evidence.middle.data(), reach * reach, near,
                                nanoflann::SearchParams(0, 0, false));
        for (const auto& [place, squared_distance] : near) {
          const TrackedLoop& other = loops[others.loops[place]];
          const double ratio = other.evidence.radius / radius;
          if (&other != &loop && ratio >= 0.5 && ratio <= 2) ++loop.evidence.alike;
        }
      }
    }
  }
}

// All of them are chosen.
TrackedLoops all_loops(std::vector<LevelLoops> levels) {
  TrackedLoops tracked;
  const auto count = static_cast<std::uint32_t>(levels.front().loops.size());
  for (std::uint32_t loop = 0; loop < count; ++loop) tracked.loops.chosen.push_back({0, loop});
  tracked.loops.levels.push_back(std::move(levels.front().loops));
  tracked.tracks.resize(count);
  return tracked;
}

}  // namespace

TrackedLoops track_loops(std::vector<LevelLoops> levels, Job& job) {
  if (job.config.loops.method == LoopMethod::kPaper) return all_loops(std::move(levels));
  Phase phase(job.phases, "track", 0);
  const std::vector<NearLoops> pairs = near_loops(levels, job.spill, job.workers);
  std::vector<TrackedLoop> loops = loops_of(levels);
  follow(pairs, loops);
  rate(levels, loops);
  std::vector<std::uint32_t> chosen = choose(pairs, loops);
  const double min_confidence = job.config.selection.min_confidence;
  count_alike(chosen, min_confidence, loops);
  for (const std::uint32_t i : chosen) loops[i].log_odds = log_odds(loops[i].evidence);
  std::erase_if(chosen, [&](std::uint32_t i) { return probability_of(loops[i].log_odds) < min_confidence; });
  // At most one of several loops with the same points is chosen.
  std::sort(chosen.begin(), chosen.end(), [&](std::uint32_t x, std::uint32_t y) {
    return compare_points(levels[loops[x].level].loops, loops[x].loop, levels[loops[y].level].loops,
                          loops[y].loop) < 0;
  });

  TrackedLoops tracked;
  for (const std::uint32_t i : chosen) {
    const TrackedLoop& loop = loops[i];
    tracked.loops.chosen.push_back({loop.level, loop.loop});
    tracked.tracks.push_back({.confidence = probability_of(loop.log_odds),
                              .evidence = loop.evidence,
                              .first_scale = levels[loop.first].edge,
                              .last_scale = levels[loop.last].edge});
  }
  for (LevelLoops& level : levels) tracked.loops.levels.push_back(std::move(level.loops));
  return tracked;
}

}  // namespace lacuna
