// SPDX-License-Identifier: Apache-2.0
// split: orders the counted cells as a kd-tree and cuts them into tiles.
#pragma once

#include "engine/model/cell_grid.hpp"
#include "engine/model/tiling.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna {

// The way in which cells were halved down to tiles. An inner node has the last cell of its first half. Across
// an axis, cells come by their coordinate along it, then by all coordinates.
struct Cut {
  std::int32_t axis = -1;  // -1: a tile
  CellCoord last{};
};

// The cuts of an earlier scan, for a scan that differs in few places. Tiles where nothing has changed then
// have the same points, in the same order, and the same numbers.
struct TileGuide {
  CellGrid grid;
  std::vector<Cut> cuts;  // first a node, then all of its first half, then all of its second
  std::uint64_t tile_points = 0;
  std::uint64_t cell_points = 0;
};

// Where points go while they are bucketed.
struct TilePlan {
  CellGrid grid;
  std::vector<CountedCell> cells;  // in the order of the tree, tile after tile
  std::vector<Tile> tiles;         // tiles of these cells; their rows begin where all copies would fit
  // Cells in no tile, since their points are set aside. First come the cells with more points than a tile may
  // hold, one by one. Then come the cells far from all others, together.
  std::vector<CountedCell> aside;
  std::size_t heavy = 0;          // how many of the first kind
  std::uint64_t points = 0;       // finite ones of the scan
  std::uint64_t tile_points = 0;  // the most that a tile may hold; with a guide, twice as many
  std::uint64_t cell_points = 0;  // the most in a cell of the index
  std::vector<Cut> cuts;          // as in `TileGuide`

  bool has_far() const { return aside.size() > heavy; }
  std::size_t groups() const { return heavy + has_far(); }
  std::uint64_t group_points(std::size_t group) const;  // or more, where a cell has `kMostCounted`
  // Returns a number no less than the number of tiles in the end.
  std::uint64_t most_tiles() const;
};

// Halves the cells along the longest side of their box, at the point count's median. A run that holds at most
// `tile_points` points becomes a tile. Halving goes on below, down to few cells, so that cells near in the
// order are near in space. Far cells are set aside: they would widen the boxes of all runs. Cost: n log n in
// cells. `guide`: cuts in the same grid; null: no guide. A tile of it is halved only where it would hold
// twice `tile_points` or more, and stays where it holds no cell.
TilePlan split_tiles(std::vector<CountedCell> cells, const CellGrid& grid, std::uint64_t points,
                     std::uint64_t tile_points, const TileGuide* guide = nullptr);

}  // namespace lacuna
