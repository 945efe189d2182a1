// SPDX-License-Identifier: Apache-2.0
#include "engine/store/vdb_transform.hpp"

#include <cmath>

namespace lacuna {

bool is_in_world_units(const CellGrid& grid) {
  return grid.edge() >= 0x1p-16 && grid.edge() <= 0x1p300;
}

openvdb::math::Transform::Ptr vdb_transform(const CellGrid& grid) {
  const double edge = is_in_world_units(grid) ? grid.edge() : 1;
  const double finest = std::ldexp(edge, -grid.shift);
  const auto along = [&](std::size_t axis) { return grid.origin[axis] * finest + edge / 2; };
  const auto transform = openvdb::math::Transform::createLinearTransform(edge);
  transform->postTranslate({along(0), along(1), along(2)});
  return transform;
}

}  // namespace lacuna
