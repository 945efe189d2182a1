// index.vdb: the counted cells as OpenVDB grids, for OpenVDB's own tools.
#pragma once

#include "engine/model/cell_grid.hpp"

#include <cstdint>
#include <filesystem>
#include <span>

namespace lacuna {

struct IndexedCell {
  CellCoord coord;
  std::int32_t points, tile;  // with copies; -1: in several tiles
};

// Writes grids `points` and `tile`. Memory: 600 KB for each cell that is far from all others. Throws `Error` where it
// cannot.
void save_index(const CellGrid& grid, std::span<const IndexedCell> cells, const std::filesystem::path& file);

}  // namespace lacuna
