// SPDX-License-Identifier: Apache-2.0
// Points of loops from vectors, and loops that are drawn by a test, with their measures.
#pragma once

#include "engine/loops/measure_loops.hpp"
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

struct DrawnLoop {
  std::vector<Eigen::Vector3d> points;
  LoopKind kind = LoopKind::kHole;
};

// A square, with `on_side` points from a corner to the next.
DrawnLoop square(double half, LoopKind kind, const Eigen::Vector3d& centre = {0, 0, 0}, int on_side = 5);

MeasuredLoops measured(std::span<const DrawnLoop> drawn, const std::filesystem::path& folder);

}  // namespace lacuna::test
