// SPDX-License-Identifier: Apache-2.0
// The directions in which a scanner had returns: how far up and down, and how far around.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace lacuna::io {

// Ranges in one direction that differ by more than this share are of two surfaces, and a ray ends at the
// first.
inline constexpr double kConflict = 0.1;

// How far the rays of a scanner spread around their mean direction. From a place far off, all points lie in
// one direction, and ranges say nothing of what is before what.
class RaySpread {
 public:
  void add(const Eigen::Vector3d& direction) {  // of length 1
    sum_ += direction;
    ++count_;
  }
  // Returns the root mean square of the angles to the mean direction, in radians; 0 without rays. It is
  // small, or an estimate.
  double angle() const;
  // Whether no scanner has so narrow a view: 4 degrees, as a square window of 10 degrees. A few rays do not
  // count.
  bool is_narrow() const;

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  std::uint64_t count_ = 0;
};

class FieldOfView {
 public:
  explicit FieldOfView(const Eigen::Vector3d& axis);
  void add(const Eigen::Vector3d& direction);
  bool contains(const Eigen::Vector3d& direction) const;  // both of length 1

  double lowest() const { return lowest_; }  // sines of the elevation; lowest > highest: nothing was added
  double highest() const { return highest_; }
  double turn() const;  // share of a whole turn around the axis

 private:
  std::size_t bin_of(const Eigen::Vector3d& direction) const;

  Eigen::Vector3d axis_, right_, forward_;
  double lowest_ = 1, highest_ = -1;
  std::bitset<512> bins_;  // around the axis, with returns
};

}  // namespace lacuna::io
