// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/field_of_view.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace lacuna::io {

double RaySpread::angle() const {
  const double mean = sum_.norm() / static_cast<double>(std::max<std::uint64_t>(count_, 1));
  return std::sqrt(std::max(0.0, 2 * (1 - mean)));
}

bool RaySpread::is_narrow() const {
  constexpr double kNarrow = 0.07;
  constexpr std::uint64_t kFewRays = 100;
  return count_ >= kFewRays && angle() < kNarrow;
}

FieldOfView::FieldOfView(const Eigen::Vector3d& axis)
    : axis_(axis), right_(axis.unitOrthogonal()), forward_(axis.cross(right_)) {}

// Uses the sums of components. An arc tangent differs between machines.
std::size_t FieldOfView::bin_of(const Eigen::Vector3d& direction) const {
  const double x = direction.dot(right_), y = direction.dot(forward_);
  const double sum = std::fabs(x) + std::fabs(y);
  if (sum == 0) return 0;
  const double quarter = y >= 0 ? 1 - x / sum : 3 + x / sum;  // from 0 to 4
  const double quarters = static_cast<double>(bins_.size()) / 4;
  return std::min(static_cast<std::size_t>(quarter * quarters), bins_.size() - 1);
}

void FieldOfView::add(const Eigen::Vector3d& direction) {
  const double sine = direction.dot(axis_);
  lowest_ = std::min(lowest_, sine);
  highest_ = std::max(highest_, sine);
  bins_[bin_of(direction)] = true;
}

bool FieldOfView::contains(const Eigen::Vector3d& direction) const {
  const double sine = direction.dot(axis_);
  return sine >= lowest_ && sine <= highest_ && bins_[bin_of(direction)];
}

double FieldOfView::turn() const {
  return static_cast<double>(bins_.count()) / static_cast<double>(bins_.size());
}

}  // namespace lacuna::io
