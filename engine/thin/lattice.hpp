// SPDX-License-Identifier: Apache-2.0
// The lattice of a level consists of cubes of one edge, counted from the origin of the coordinates. So the
// cell of a point depends on that point alone. Cells at 0 reach a quarter of an edge below it. Walls and
// floors are often at 0, and noise would share their points out among the cells of both sides.
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace lacuna {

// Where a point lies.
struct PointInCell {
  Eigen::Vector3d cell;   // whole numbers
  double squared_offset;  // squared distance to the cell's middle, in edges
  std::uint64_t hash;     // of the cell
};

std::uint64_t hash_of(const Eigen::Vector3d& cell);

inline constexpr double kBelowOrigin = 0.25;  // in edges: how far the cells at 0 reach

class Lattice {
 public:
  explicit Lattice(double edge) : per_length_(1 / edge) {}  // edge: above 0

  // Returns the place of a point. Its cell is not finite where the coordinates are too large for the edge.
  PointInCell place_of(const Eigen::Vector3d& position) const;

 private:
  double per_length_;
};

}  // namespace lacuna
