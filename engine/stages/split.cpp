#include "engine/stages/split.hpp"

#include <algorithm>
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
    const auto across = [&](const CountedCell& a, const CountedCell& b) {
      if (a.coord[longest] != b.coord[longest]) return a.coord[longest] < b.coord[longest];
      return a.coord < b.coord;
    };
    // The half-way point lies in [first, last): halved until that is one cell.
    std::uint32_t first = node.first, last = node.last;
    std::uint64_t before = 0;
    while (last - first > 1) {
      const std::uint32_t middle = first + (last - first) / 2;
      const auto cells = tiling_.cells.begin();
      std::nth_element(cells + first, cells + middle, cells + last, across);
      std::uint64_t points = before;
      for (std::uint32_t i = first; i < middle; ++i) points += tiling_.cells[i].points;
      if (points <= node.points / 2) {
        before = points;
        first = middle;
      } else {
        last = middle;
      }
    }
    return std::clamp(first, node.first + 1, node.last - 1);
  }

  Tiling& tiling_;
  std::uint64_t tile_points_;
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
