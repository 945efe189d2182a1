// SPDX-License-Identifier: Apache-2.0
// Decides what lies inside a loop.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {

// A closed polygon, viewed along its normal, the direction of its area vector.
class Outline {
 public:
  // A polygon without an area, or with a point that is not finite, has no inside.
  explicit Outline(std::span<const Eigen::Vector3d> polygon);

  // Whether a line from the place along the normal crosses the polygon's surface. Then a ray in the plane
  // crosses the polygon's edges an odd number of times. Cost: constant for most polygons.
  bool contains(const Eigen::Vector3d& place) const;

 private:
  Eigen::Vector2d project(const Eigen::Vector3d& place) const;
  std::size_t strip_of(double y) const;

  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero(), x_axis_, y_axis_;
  std::vector<Eigen::Vector2d> corners_;
  // Strips of equal height divide the polygon. Each strip lists its edges by their first corner.
  double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -lowest_, height_ = 0;
  std::vector<std::vector<std::size_t>> strips_;
};

}  // namespace lacuna::evaluation
