// SPDX-License-Identifier: Apache-2.0
// order_tile: brings a tile's points into store order, without exact copies, and makes the cells that they
// form.
#pragma once

#include "engine/model/cell_grid.hpp"
#include "engine/model/tiling.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

struct OrderedTile {
  std::vector<std::uint32_t> order;  // of each distinct point, its place in the input
  std::vector<Cell> cells;           // of the ordered points, one after the other; without rows
  std::vector<Duplicate> duplicates;
};

// `cells`: the counted cell of each point, from the tile's first; `cell_count`: of the tile. Points come by
// counted cell, then along a Z curve through it. A counted cell with more than four times `cell_points`
// points becomes several cells of at most `cell_points`, however its points are spread. Where points have the
// same coordinates, the lowest id is kept for all. Cost: n log(points per counted cell).
OrderedTile order_tile(std::span<const ScanPoint> points, std::span<const std::uint32_t> cells,
                       std::size_t cell_count, const CellGrid& grid, std::uint64_t cell_points);

}  // namespace lacuna
