// SPDX-License-Identifier: Apache-2.0
// The convex hull of points that come one by one.
#pragma once

#include "io/explain/area/plan_polygon.hpp"

#include <Eigen/Core>

namespace lacuna::io {

// Memory: the hull, and some thousand points. Cost: the logarithm of that for each point.
class ConvexHull {
 public:
  void add(const Eigen::Vector2d& point) {
    points_.push_back(point);
    if (points_.size() >= 2 * kept_ + kBuffer) reduce();
  }
  // Returns its corners counter-clockwise; fewer than three where all points lie on a line.
  Ring2 corners() {
    reduce();
    return points_;
  }

 private:
  static constexpr std::size_t kBuffer = 4096;
  void reduce();

  Ring2 points_;
  std::size_t kept_ = 0;
};

}  // namespace lacuna::io
