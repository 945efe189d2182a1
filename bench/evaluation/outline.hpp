// SPDX-License-Identifier: Apache-2.0
// What lies inside a loop.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {

// A closed polygon as seen along its normal, the direction of its area vector.
class Outline {
 public:
  // One without an area, or with a point that is not finite, has no inside.
  explicit Outline(std::span<const Eigen::Vector3d> polygon);

  // A line from there along the normal crosses the polygon's surface: a ray in the plane crosses its edges an
  // odd number of times. Cost: constant for most polygons.
  bool contains(const Eigen::Vector3d& place) const;

 private:
  Eigen::Vector2d project(const Eigen::Vector3d& place) const;
  std::size_t strip_of(double y) const;

  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero(), x_axis_, y_axis_;
  std::vector<Eigen::Vector2d> corners_;
  // Strips of equal height across the polygon, with the edges in each by their first corner.
  double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -lowest_, height_ = 0;
  std::vector<std::vector<std::size_t>> strips_;
};

}  // namespace lacuna::evaluation
