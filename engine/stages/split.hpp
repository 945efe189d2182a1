// split: orders the counted cells as a kd-tree and cuts it into tiles.
#pragma once

#include "engine/data/tiling.hpp"

#include <cstdint>
#include <vector>

namespace lacuna {

// Halves the cells along the longest side of their box, at the point count's median, until a node holds at
// most `tile_points` points: a tile, or a single cell with more. Goes on below, down to `kLeafCells` cells,
// so that the same tree finds cells near a place. No cells: no nodes, no tiles. Cost: n log n in cells.
Tiling split_tiles(std::vector<CountedCell> cells, const CellGrid& grid, std::uint64_t tile_points);

inline constexpr std::uint32_t kLeafCells = 4;

}  // namespace lacuna
