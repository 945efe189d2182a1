// SPDX-License-Identifier: Apache-2.0
// Directions in cells: each of the six faces of a cube has `edge` times `edge` square cells.
#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace lacuna::io {

// Faces are at right angles to the axes. So directions need no arithmetic but divisions, and have the same
// cell on every machine. The direction need not have length 1, but must not be 0.
std::size_t cell_of(const Eigen::Vector3d& direction, std::size_t edge);
Eigen::Vector3d direction_of(std::size_t cell, std::size_t edge);  // its middle, of length 1

// Radians that a cell is wide in the middle of a face; half of that at its sides.
inline double cell_angle(std::size_t edge) {
  return 2 / static_cast<double>(edge);
}

}  // namespace lacuna::io
