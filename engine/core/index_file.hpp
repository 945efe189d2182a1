// index.vdb: the counted cells as OpenVDB grids, for OpenVDB's own tools.
#pragma once

#include "engine/data/cell_grid.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace lacuna {

struct IndexedCell {
  CellCoord coord;
  std::int32_t points, tile;  // with copies; -1: in several tiles
};

// Writes grids `points` and `tile`. Memory: 600 KB for each cell that is far from all others. Throws `Error`
// where it cannot, or where the module that can, lacuna_vdb.so beside the program, is missing.
void save_index(const CellGrid& grid, std::span<const IndexedCell> cells, const std::filesystem::path& file);

// Returns what went wrong, empty if nothing did. `edge`: of the cells.
using WriteIndex = std::string(double edge, std::span<const IndexedCell> cells,
                               const std::filesystem::path& file);

}  // namespace lacuna
