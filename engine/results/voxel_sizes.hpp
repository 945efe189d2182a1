// SPDX-License-Identifier: Apache-2.0
// How large a voxel must be so that a grid of OpenVDB stays small, whatever the scan.
#pragma once

#include "engine/model/cell_grid.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// The order of a Z curve, so that voxels in this order stay in order when their size doubles. Axes are
// equally large.
bool comes_before_along_z(const CellCoord& a, const CellCoord& b);

// Adds up the memory that OpenVDB's tree of floats takes, for each number of doublings of the voxel size.
// Nodes of 4096^3 voxels with less than a thousandth of the points are left out: those of outliers would take
// 300 KB each.
class VoxelSizes {
 public:
  static constexpr int kMostDoublings = 24;

  // `points`: of all voxels together.
  explicit VoxelSizes(std::uint64_t points) : all_points_(points) {}

  // Voxels in the order of the Z curve, each once.
  void add(const CellCoord& voxel, std::uint64_t points);
  void finish();

  // Fewest doublings with which the tree takes at most `bytes`.
  int doublings_within(std::uint64_t bytes) const;
  // Nodes of 4096^3 voxels that are kept, in the order of the Z curve: coordinates divided by 4096.
  std::span<const CellCoord> kept_nodes(int doublings) const {
    return levels_[static_cast<std::size_t>(doublings)].kept;
  }
  static CellCoord node_of(const CellCoord& voxel, int doublings);

 private:
  struct Level {
    std::uint64_t bytes = 0;                        // of kept nodes
    std::uint64_t node_bytes = 0, node_points = 0;  // of the node under way
    std::vector<CellCoord> kept;
  };
  void end_node(int doublings);

  std::uint64_t all_points_;
  std::array<Level, kMostDoublings + 1> levels_;
  CellCoord last_{};
  bool is_first_ = true;
};

}  // namespace lacuna
