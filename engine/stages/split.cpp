#include "engine/stages/split.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <numeric>

namespace lacuna {
namespace {

class Splitter {
 public:
  Splitter(Tiling& tiling, std::uint64_t tile_points) : tiling_(tiling), tile_points_(tile_points) {}

  // Returns the node's index. `in_tile`: an ancestor is a tile already.
  std::uint32_t split(std::uint32_t first, std::uint32_t last, bool in_tile) {
    const auto index = static_cast<std::uint32_t>(tiling_.nodes.size());
    tiling_.nodes.push_back(bound(first, last));
    const std::uint64_t points = tiling_.nodes[index].points;
    if (!in_tile && (points <= tile_points_ || last - first == 1)) {
      tiling_.tiles.push_back({.first_cell = first, .last_cell = last, .raw = points});
      in_tile = true;
    }
    if (in_tile && last - first <= kLeafCells) return index;
    const std::uint32_t middle = halve(tiling_.nodes[index]);
    const std::uint32_t left = split(first, middle, in_tile);
    const std::uint32_t right = split(middle, last, in_tile);
    tiling_.nodes[index].left = left;
    tiling_.nodes[index].right = right;
    return index;
  }

 private:
  CellNode bound(std::uint32_t first, std::uint32_t last) const {
    CellNode node{
        .low = tiling_.cells[first].coord, .high = tiling_.cells[first].coord, .first = first, .last = last};
    for (std::uint32_t i = first; i < last; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis] = std::min(node.low[axis], tiling_.cells[i].coord[axis]);
        node.high[axis] = std::max(node.high[axis], tiling_.cells[i].coord[axis]);
      }
      node.points += tiling_.cells[i].points;
    }
    return node;
  }

  // Parts the node's cells across its longest side, half of the points before and half behind; returns the
  // first cell of the second half.
  std::uint32_t halve(const CellNode& node) {
    const auto side = [&](int axis) { return std::int64_t{node.high[axis]} - node.low[axis]; };
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (side(axis) > side(longest)) longest = axis;
    }
    // A histogram across finds the slab of cells that holds the half-way point; only that is ordered.
    const auto begin = tiling_.cells.begin() + node.first, end = tiling_.cells.begin() + node.last;
    const auto most_slabs = std::max<std::uint64_t>(node.last - node.first, 2);
    const auto width = std::bit_width(static_cast<std::uint64_t>(side(longest)) / most_slabs);
    const auto slab_of = [&](const CountedCell& cell) {
      return static_cast<std::size_t>((std::int64_t{cell.coord[longest]} - node.low[longest]) >> width);
    };
    slabs_.assign(static_cast<std::size_t>(side(longest) >> width) + 1, 0);
    for (auto cell = begin; cell != end; ++cell) slabs_[slab_of(*cell)] += cell->points;
    std::uint64_t before = 0;
    std::size_t half_way = 0;
    while (before + slabs_[half_way] <= node.points / 2) before += slabs_[half_way++];
    const auto slab_begin =
        std::partition(begin, end, [&](const auto& cell) { return slab_of(cell) < half_way; });
    const auto slab_end =
        std::partition(slab_begin, end, [&](const auto& cell) { return slab_of(cell) == half_way; });

    const auto across = [&](const CountedCell& a, const CountedCell& b) {
      if (a.coord[longest] != b.coord[longest]) return a.coord[longest] < b.coord[longest];
      return a.coord < b.coord;
    };
    // The half-way point lies in [first, last): halved until that is one cell.
    auto first = slab_begin, last = slab_end;
    while (last - first > 1) {
      const auto middle = first + (last - first) / 2;
      std::nth_element(first, middle, last, across);
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
    const auto half = static_cast<std::uint32_t>(first - tiling_.cells.begin());
    return std::clamp(half, node.first + 1, node.last - 1);
  }

  Tiling& tiling_;
  std::uint64_t tile_points_;
  std::vector<std::uint64_t> slabs_;  // points of each
};

}  // namespace

Tiling split_tiles(std::vector<CountedCell> cells, const CellGrid& grid, std::uint64_t tile_points) {
  Tiling tiling{.grid = grid, .cells = std::move(cells)};
  if (tiling.cells.empty()) return tiling;
  Splitter(tiling, tile_points).split(0, static_cast<std::uint32_t>(tiling.cells.size()), false);
  std::uint64_t row = 0;
  for (Tile& tile : tiling.tiles) {
    tile.first_row = Row{row};
    row += (tile.raw + kRowAlignment - 1) / kRowAlignment * kRowAlignment;
  }
  assert(tiling.check());
  return tiling;
}

}  // namespace lacuna
