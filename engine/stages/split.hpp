// split: orders the counted cells as a kd-tree and cuts them into tiles.
#pragma once

#include "engine/data/cell_grid.hpp"
#include "engine/data/tiling.hpp"

#include <cstdint>
#include <vector>

namespace lacuna {

// Where points go while they are bucketed.
struct TilePlan {
  CellGrid grid;
  std::vector<CountedCell> cells;  // in the order of the tree, tile after tile
  std::vector<Tile> tiles;         // of these cells; their rows begin where all copies would fit
  std::vector<CountedCell> heavy;  // cells that are no part of a tile: their points are set aside
  std::uint64_t tile_points = 0;   // the most that a tile may hold

  // No less than the number of tiles in the end.
  std::uint64_t most_tiles() const;
};

// Halves the cells along the longest side of their box, at the point count's median, until a part holds at
// most `tile_points` points: a tile. Goes on below, down to few cells, so that cells near in the order are
// near in space. Heavy are cells with more points than a tile may hold, and cells without end. Cost: n log n
// in cells.
TilePlan split_tiles(std::vector<CountedCell> cells, const CellGrid& grid, std::uint64_t tile_points);

}  // namespace lacuna
