// SPDX-License-Identifier: Apache-2.0
// The directions in which a scanner had returns: how far up and down, and how far around.
#pragma once

#include <bitset>
#include <cstddef>

#include <Eigen/Core>

namespace lacuna::io {

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
