// SPDX-License-Identifier: Apache-2.0
// Loops drawn by hand, with the direction in which the surface around them lies.
#pragma once

#include "engine/model/loop.hpp"
#include "tests/support/loop_points.hpp"

namespace lacuna::test {

using Line = std::vector<Eigen::Vector3d>;

// A hole in the plane z = 0 around the polygon: the surface lies outside.
inline Loop hole_in_plane(const Line& polygon) {
  const std::size_t n = polygon.size();
  double area = 0;
  for (std::size_t i = 0; i < n; ++i)
    area += polygon[i].x() * polygon[(i + 1) % n].y() - polygon[i].y() * polygon[(i + 1) % n].x();
  Loop loop;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d along = polygon[(i + 1) % n] - polygon[(i + n - 1) % n];
    const Eigen::Vector3d out(along.y(), -along.x(), 0);
    loop.push_back(loop_point(i, polygon[i], ((area > 0 ? 1.0 : -1.0) * out).cast<float>()));
  }
  return loop;
}

// The corners, with so many points on each side.
inline Line with_points(const Line& corners, int points) {
  Line line;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d along = corners[(i + 1) % corners.size()] - corners[i];
    for (int k = 0; k < points; ++k) line.push_back(corners[i] + along * k / points);
  }
  return line;
}

// The hole of a sphere of radius 1 without its cap of this half angle, seen from its middle.
inline Loop hole_in_sphere(double half_angle, int points) {
  Loop loop;
  for (int i = 0; i < points; ++i) {
    const double turn = 2 * std::numbers::pi * i / points;
    const Eigen::Vector3d out(std::cos(turn), std::sin(turn), 0), up(0, 0, 1);
    loop.push_back(loop_point(static_cast<std::uint64_t>(i),
                              std::sin(half_angle) * out + std::cos(half_angle) * up,
                              (std::cos(half_angle) * out - std::sin(half_angle) * up).cast<float>()));
  }
  return loop;
}

// Moved by a rigid motion.
inline Loop moved(Loop loop, const Eigen::Isometry3d& motion) {
  for (LoopPoint& point : loop) {
    move_to(point, motion * point.position());
    surface_of(point) = motion.linear().cast<float>() * surface_of(point).eval();
  }
  return loop;
}

// An L and a comb with three teeth: simple polygons that are not convex.
inline Line shape_of_l() {
  return {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};  // 6
}
inline Line comb() {
  return {{0, 0, 0}, {5, 0, 0}, {5, 4, 0}, {4, 4, 0}, {4, 1, 0}, {3, 1, 0},
          {3, 4, 0}, {2, 4, 0}, {2, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}};  // 14
}
// By the formula of Gauss.
inline double plane_area(const Line& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return std::abs(twice) / 2;
}

}  // namespace lacuna::test
