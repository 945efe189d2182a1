// Grids of a .vdb file, read by OpenVDB's own reader.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace lacuna::test {

struct VdbGrid {
  double voxel = 0;  // edge, units of the scan
  std::int32_t background = 0;
  std::map<std::array<std::int32_t, 3>, std::int32_t> values;  // of the active voxels
};

// Every grid by name; each holds 32-bit integers, else std::runtime_error.
std::map<std::string, VdbGrid> read_vdb_grids(const std::filesystem::path& file);

}  // namespace lacuna::test
