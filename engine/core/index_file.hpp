// index.vdb: the cells of a tiling as OpenVDB grids, for OpenVDB's own tools.
#pragma once

#include "engine/data/tiling.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace lacuna {

// Writes grids `points` and `tile`. Memory: 600 KB for each cell that is far from all others. Throws `Error`
// where it cannot, or where the module that can, lacuna_vdb.so beside the program, is missing.
void save_index(const Tiling& tiling, const std::filesystem::path& file);

// What that module is given.
struct IndexedCell {
  CellCoord coord;
  std::int32_t points, tile;
};

// Returns what went wrong, empty if nothing did. `edge`: of the cells.
using WriteIndex = std::string(double edge, std::span<const IndexedCell> cells,
                               const std::filesystem::path& file);

}  // namespace lacuna
