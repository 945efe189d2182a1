// SPDX-License-Identifier: Apache-2.0
// Grids of a .vdb file, read by OpenVDB's own reader.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include <Eigen/Geometry>

namespace lacuna::test {

struct VdbGrid {
  double voxel = 0;  // edge, units of the scan
  double background = 0;
  std::map<std::array<std::int32_t, 3>, double> values;  // of the active voxels
  std::array<double, 3> first_voxel{};                   // the middle of voxel (0, 0, 0)
  std::map<std::string, std::string> metadata;           // as text

  Eigen::AlignedBox3d box(const std::array<std::int32_t, 3>& voxel) const;
};

// Every grid by name; each holds 32-bit integers or floats, else std::runtime_error.
std::map<std::string, VdbGrid> read_vdb_grids(const std::filesystem::path& file);

}  // namespace lacuna::test
