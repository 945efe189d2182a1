// index.vdb: the index of a scan, as the workspace keeps it for other processes.
#pragma once

#include "engine/bucket/cell_index.hpp"
#include "engine/model/tiling.hpp"

#include <filesystem>

namespace lacuna {

struct StoredIndex {
  CellIndex index;
  Tiling tiling;
};

// Writes the grid `cell`: in each voxel the number of its first cell of the tiling. Far cells have no voxel.
// The metadata of the file holds the lattice of the cells, and one record for each tile: its cells with their
// boxes. Memory: 64 bytes for each cell. Throws `Error`.
void save_index(const CellIndex& index, const Tiling& tiling, const std::filesystem::path& file);

// Returns what `save_index` wrote, with the tree over the cells. Throws `Error` for any other file.
StoredIndex read_index(const std::filesystem::path& file);

}  // namespace lacuna
