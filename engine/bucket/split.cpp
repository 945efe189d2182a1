// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/split.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <string>

namespace lacuna {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

// A tile at work takes these bytes, whatever its points.
constexpr std::uint64_t kTileBytes = kMiB / 4;

// Stored point, position, id, row, tree, evaluation, edges, outputs; k neighbours in two lists.
std::uint64_t bytes_per_tile_point(const Config& config) {
  return 420 + 12 * static_cast<std::uint64_t>(config.neighbourhood.k) + (config.normals.orient ? 80 : 0);
}

// The limits of the points of a tile. With fewer, the tables with entries for every tile do not fit in
// memory. With more, a tile does not fit, or its neighbours cannot be numbered in 32 bits.
struct TileSizes {
  std::uint64_t least, most;
};

TileSizes tile_sizes(const Memory& memory, std::uint64_t points, const Config& config) {
  constexpr std::uint64_t kTables = 1 << 10;  // bytes for each tile, in all tables that exist at a time
  const std::uint64_t neighbours =
      2 * static_cast<std::uint64_t>(config.neighbourhood.k);  // of a point, on average at most
  return {.least = points / (memory.lists / kTables) + 1,
          .most = std::min((memory.tiles - kTileBytes) / bytes_per_tile_point(config),
                           std::numeric_limits<std::uint32_t>::max() / neighbours)};
}

// Below this number, the order of cells does not matter.
constexpr std::uint32_t kFewCells = 4;

class Splitter {
 public:
  explicit Splitter(TilePlan& plan) : plan_(plan) {}

  void split() { split(0, static_cast<std::uint32_t>(plan_.cells.size()), false); }

 private:
  // `in_tile`: a tile holds these cells already.
  void split(std::uint32_t first, std::uint32_t last, bool in_tile) {
    const Part part = bound(first, last);
    if (!in_tile && part.points <= plan_.tile_points) {
      plan_.tiles.push_back({.first_cell = first, .last_cell = last, .raw = part.points});
      in_tile = true;
    }
    if (in_tile && last - first <= kFewCells) {
      std::sort(plan_.cells.begin() + first, plan_.cells.begin() + last,
                [](const CountedCell& a, const CountedCell& b) { return a.coord < b.coord; });
      return;
    }
    const std::uint32_t middle = halve(part, longest_axis(part));
    split(first, middle, in_tile);
    split(middle, last, in_tile);
  }

  struct Across {
    std::size_t axis;
    bool operator()(const CountedCell& a, const CountedCell& b) const { return (*this)(a.coord, b.coord); }
    bool operator()(const CellCoord& a, const CellCoord& b) const {
      return a[axis] != b[axis] ? a[axis] < b[axis] : a < b;
    }
  };

  struct Part {
    CellCoord low{}, high{};  // tight bounds of its cells
    std::uint32_t first = 0, last = 0;
    std::uint64_t points = 0;
  };

  Part bound(std::uint32_t first, std::uint32_t last) const {
    Part part{.first = first, .last = last};
    if (first == last) return part;
    part.low = part.high = plan_.cells[first].coord;
    for (std::uint32_t i = first; i < last; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        part.low[axis] = std::min(part.low[axis], plan_.cells[i].coord[axis]);
        part.high[axis] = std::max(part.high[axis], plan_.cells[i].coord[axis]);
      }
      part.points += plan_.cells[i].points;
    }
    return part;
  }

  static std::int64_t side(const Part& part, std::size_t axis) {
    return std::int64_t{part.high[axis]} - part.low[axis];
  }
  static std::size_t longest_axis(const Part& part) {
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (side(part, axis) > side(part, longest)) longest = axis;
    }
    return longest;
  }

  // Divides the cells across the longest side, half of the points before and half behind. Returns the first
  // cell of the second half.
  std::uint32_t halve(const Part& node, std::size_t longest) {
    // A histogram across finds the slab of cells that holds the half-way point; only that is ordered.
    const auto begin = plan_.cells.begin() + node.first, end = plan_.cells.begin() + node.last;
    const auto most_slabs = std::max<std::uint64_t>(node.last - node.first, 2);
    const auto width = std::bit_width(static_cast<std::uint64_t>(side(node, longest)) / most_slabs);
    const auto slab_of = [&](const CountedCell& cell) {
      return static_cast<std::size_t>((std::int64_t{cell.coord[longest]} - node.low[longest]) >> width);
    };
    slabs_.assign(static_cast<std::size_t>(side(node, longest) >> width) + 1, 0);
    for (auto cell = begin; cell != end; ++cell) slabs_[slab_of(*cell)] += cell->points;
    std::uint64_t before = 0;
    std::size_t half_way = 0;
    while (before + slabs_[half_way] <= node.points / 2) before += slabs_[half_way++];
    const auto slab_begin =
        std::partition(begin, end, [&](const auto& cell) { return slab_of(cell) < half_way; });
    const auto slab_end =
        std::partition(slab_begin, end, [&](const auto& cell) { return slab_of(cell) == half_way; });

    // The half-way point lies in [first, last): halved until that is one cell.
    auto first = slab_begin, last = slab_end;
    while (last - first > 1) {
      const auto middle = first + (last - first) / 2;
      std::nth_element(first, middle, last, Across{longest});
      const std::uint64_t points =
          std::accumulate(first, middle, before,
                          [](std::uint64_t sum, const CountedCell& cell) { return sum + cell.points; });
      if (points <= node.points / 2) {
        before = points;
        first = middle;
      } else {
        last = middle;
      }
    }
    const auto half = static_cast<std::uint32_t>(first - plan_.cells.begin());
    return std::clamp(half, node.first + 1, node.last - 1);
  }

  TilePlan& plan_;
  std::vector<std::uint64_t> slabs_;  // points of each
};

}  // namespace

std::uint64_t tile_bytes(std::uint64_t points, const Config& config) {
  return points * bytes_per_tile_point(config) + kTileBytes;
}

std::uint64_t points_per_tile(std::uint64_t points, const Config& config, const Workers& workers) {
  constexpr std::uint64_t kLeast = 4096;        // smaller ones are mostly border
  constexpr std::uint64_t kMost = 256 << 10;    // larger ones gain little
  constexpr std::uint64_t kTilesPerThread = 2;  // so that the last tiles do not leave threads idle
  const Memory& memory = workers.memory;
  TileSizes sizes = tile_sizes(memory, points, config);
  if (sizes.least > sizes.most) {
    std::uint64_t limit = memory.limit / kMiB * kMiB;
    while (sizes.least > sizes.most) sizes = tile_sizes(Memory::share(limit += kMiB), points, config);
    throw Error("the memory limit of " + std::to_string(memory.limit / kMiB) + " MiB is too small for " +
                std::to_string(points) + " points; allowed: " + std::to_string(limit / kMiB) + "MiB or more");
  }
  if (config.run.tile_points > 0)
    return std::clamp(static_cast<std::uint64_t>(config.run.tile_points), sizes.least, sizes.most);
  // Halves are not quite equal: without space for the larger ones some would be halved once more.
  const std::uint64_t threads = workers.arena.threads(), even = points * 9 / 8 / (kTilesPerThread * threads);
  // Without the fixed bytes of each further tile: tiles are rarely full, and `for_each_within_budget` holds
  // the budget. Smaller tiles cost more time: within 64 MiB, 16 threads took 17 % longer with them counted.
  const std::uint64_t wanted = std::min(std::clamp(even, kLeast, kMost), sizes.most / threads);
  return std::max(wanted, sizes.least);
}

std::uint64_t points_per_cell(std::uint64_t points, const Memory& memory) {
  constexpr std::uint64_t kFew = 32;
  constexpr std::uint64_t kBytesPerCell = 128;  // with its share of the tree
  // Cuts leave cells about half full.
  return std::max(kFew, 2 * points * kBytesPerCell / memory.cells);
}

std::uint64_t TilePlan::group_points(std::size_t group) const {
  const std::uint64_t counted = group < heavy.size() ? heavy[group].points : far_points;
  return counted < kMostCounted ? counted : points;  // counting ended there
}

std::uint64_t TilePlan::most_tiles() const {
  std::uint64_t most = tiles.size();
  for (std::size_t group = 0; group < groups(); ++group)
    most += (group_points(group) + tile_points - 1) / tile_points;
  return most;
}

TilePlan split_tiles(SurveyedScan& survey, std::uint64_t tile_points) {
  TilePlan plan{{.grid = survey.grid,
                 .far_points = survey.far_points,
                 .points = survey.points - survey.dropped,
                 .tile_points = tile_points},
                std::move(survey.cells),
                {},
                {}};
  const auto heavy = std::partition(plan.cells.begin(), plan.cells.end(),
                                    [&](const CountedCell& cell) { return cell.points <= tile_points; });
  plan.heavy.assign(heavy, plan.cells.end());
  plan.cells.erase(heavy, plan.cells.end());
  if (!plan.cells.empty()) Splitter(plan).split();
  std::uint64_t row = 0;
  for (Tile& tile : plan.tiles) {
    tile.first_row = Row{row};
    row = aligned_row(row + tile.raw);
  }
  return plan;
}

}  // namespace lacuna
