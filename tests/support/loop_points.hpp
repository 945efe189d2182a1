// SPDX-License-Identifier: Apache-2.0
// Points of loops from vectors.
#pragma once

#include "engine/model/loop.hpp"
#include "tests/support/test.hpp"

namespace lacuna::test {

inline LoopPoint loop_point(std::uint64_t id, const Eigen::Vector3d& position,
                            const Eigen::Vector3f& surface = {0, 0, 0}, float probability = 0) {
  return {ScanPoint::at(position, PointId{id}), {surface.x(), surface.y(), surface.z()}, probability};
}

inline void move_to(LoopPoint& point, const Eigen::Vector3d& position) {
  static_cast<ScanPoint&>(point) = ScanPoint::at(position, point.id);
}

inline Eigen::Map<Eigen::Vector3f> surface_of(LoopPoint& point) {
  return Eigen::Map<Eigen::Vector3f>(point.surface.data());
}
inline Eigen::Vector3f surface_of(const LoopPoint& point) {
  return Eigen::Vector3f(point.surface.data());
}

}  // namespace lacuna::test
