// SPDX-License-Identifier: Apache-2.0
// What the examples share: points to try them with, and a line of text for a hole.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include <lacuna/lacuna.hpp>

// A square of 100 x 100 points, one unit apart and a little off their grid, without those within 12 of the
// middle.
inline std::vector<Eigen::Vector3d> plane_with_hole() {
  std::vector<Eigen::Vector3d> points;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      const Eigen::Vector3d point(x + 0.2 * std::sin(7.0 * x + 3.0 * y),
                                  y + 0.2 * std::cos(5.0 * x - 2.0 * y), 0);
      if ((point - Eigen::Vector3d(50, 50, 0)).norm() > 12) points.push_back(point);
    }
  }
  return points;
}

inline void print_hole(const lacuna::LoopMeasures& hole, std::size_t points) {
  std::printf("hole at %.1f %.1f %.1f: %zu points, perimeter %.1f, diameter %.1f, confidence %.2f\n",
              hole.centroid.x(), hole.centroid.y(), hole.centroid.z(), points, hole.perimeter, hole.diameter,
              hole.track.confidence);
}
