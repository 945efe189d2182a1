// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/direction_cells.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna::io {

std::size_t cell_of(const Eigen::Vector3d& direction, std::size_t edge) {
  const double x = std::fabs(direction.x()), y = std::fabs(direction.y()), z = std::fabs(direction.z());
  const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  const double half = static_cast<double>(edge) / 2;
  const double along = std::fabs(direction[axis]);
  const auto place = [&](int other) {
    return std::min(edge - 1, static_cast<std::size_t>((direction[other] / along + 1) * half));
  };
  const std::size_t face = static_cast<std::size_t>(2 * axis) + (direction[axis] < 0 ? 1 : 0);
  return (face * edge + place((axis + 1) % 3)) * edge + place((axis + 2) % 3);
}

Eigen::Vector3d direction_of(std::size_t cell, std::size_t edge) {
  const std::size_t face = cell / (edge * edge);
  const auto place = [&](std::size_t index) {
    return (2 * static_cast<double>(index) + 1) / static_cast<double>(edge) - 1;
  };
  const int axis = static_cast<int>(face / 2);
  Eigen::Vector3d direction;
  direction[axis] = face % 2 == 0 ? 1 : -1;
  direction[(axis + 1) % 3] = place(cell / edge % edge);
  direction[(axis + 2) % 3] = place(cell % edge);
  return direction.normalized();
}

}  // namespace lacuna::io
