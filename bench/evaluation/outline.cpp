// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/outline.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace lacuna::evaluation {

Outline::Outline(std::span<const Eigen::Vector3d> polygon) {
  const std::size_t n = polygon.size();
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  if (n > 0) origin_ = polygon[0];
  for (std::size_t i = 0; i < n; ++i) {
    area += (polygon[i] - origin_).cross(polygon[(i + 1) % n] - origin_);
  }
  if (!(area.norm() > 0) || !area.allFinite()) return;
  x_axis_ = area.unitOrthogonal();
  y_axis_ = area.normalized().cross(x_axis_);

  double climb = 0;
  for (std::size_t i = 0; i < n; ++i) {
    corners_.push_back(project(polygon[i]));
    lowest_ = std::min(lowest_, corners_[i].y());
    highest_ = std::max(highest_, corners_[i].y());
    climb += std::abs(corners_[i].y() - project(polygon[(i + 1) % n]).y());
  }
  // There are as many strips as edges, unless a polygon that goes up and down would be in too many strips.
  height_ = std::max(highest_ - lowest_, climb / 4) / static_cast<double>(n);
  if (!(height_ > 0)) return;
  strips_.resize(strip_of(highest_) + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const auto [low, high] = std::minmax(corners_[i].y(), corners_[(i + 1) % n].y());
    for (std::size_t strip = strip_of(low); strip <= strip_of(high); ++strip) strips_[strip].push_back(i);
  }
}

bool Outline::contains(const Eigen::Vector3d& place) const {
  if (strips_.empty()) return false;
  const Eigen::Vector2d p = project(place);
  if (!(p.y() >= lowest_ && p.y() <= highest_)) return false;
  bool inside = false;
  for (const std::size_t i : strips_[strip_of(p.y())]) {
    const Eigen::Vector2d &a = corners_[i], &b = corners_[i + 1 < corners_.size() ? i + 1 : 0];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

Eigen::Vector2d Outline::project(const Eigen::Vector3d& place) const {
  return {(place - origin_).dot(x_axis_), (place - origin_).dot(y_axis_)};
}

std::size_t Outline::strip_of(double y) const {
  return static_cast<std::size_t>((y - lowest_) / height_);
}

}  // namespace lacuna::evaluation
