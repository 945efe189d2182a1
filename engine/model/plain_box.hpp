// SPDX-License-Identifier: Apache-2.0
// A box along the axes as plain data, which may be written to disk as it is.
#pragma once

#include <array>

#include <Eigen/Geometry>

namespace lacuna {

// Converts to and from Eigen's box, which has the geometry.
struct PlainBox {
  std::array<double, 3> low, high;  // empty where a low one is above the high one

  PlainBox() : PlainBox(Eigen::AlignedBox3d()) {}
  PlainBox(const Eigen::AlignedBox3d& box)
      : low{box.min().x(), box.min().y(), box.min().z()}, high{box.max().x(), box.max().y(), box.max().z()} {}
  operator Eigen::AlignedBox3d() const { return {min(), max()}; }

  Eigen::Vector3d min() const { return Eigen::Vector3d(low.data()); }
  Eigen::Vector3d max() const { return Eigen::Vector3d(high.data()); }
  // Extends the box by a point or by another box.
  template <class Part>
  void extend(const Part& part) {
    *this = Eigen::AlignedBox3d(*this).extend(part);
  }
};

}  // namespace lacuna
