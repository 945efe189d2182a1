// order_tile: a tile's points in cell order, without exact duplicates.
#pragma once

#include "engine/data/tiling.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

struct OrderedTile {
  std::vector<std::uint32_t> order;        // of each distinct point, its place in the input; by cell, then
                                           // along a Z curve through the cell
  std::vector<std::uint64_t> cell_points;  // distinct points of each cell
  std::vector<Duplicate> duplicates;
};

// `cells`: the cell of each point, counted from the tile's first; `cell_count`: of the tile. Of points at
// the same coordinates the lowest id is kept and stands for all. Cost: n log(points per cell).
OrderedTile order_tile(std::span<const StoredPoint> points, std::span<const std::uint32_t> cells,
                       std::size_t cell_count, const CellGrid& grid);

}  // namespace lacuna
