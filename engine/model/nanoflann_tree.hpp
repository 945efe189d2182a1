// SPDX-License-Identifier: Apache-2.0
// nanoflann's kd-tree over the caller's points.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>
#include <nanoflann.hpp>

namespace lacuna {

// `Number`: the type of the numbers of points.
template <class Number>
struct NanoflannTree {
  struct Points {
    std::span<const Eigen::Vector3d> positions;

    std::size_t kdtree_get_point_count() const { return positions.size(); }
    double kdtree_get_pt(std::size_t point, std::size_t axis) const { return positions[point][axis]; }
    template <class Bounds>
    bool kdtree_get_bbox(Bounds&) const {
      return false;
    }
  };
  using Distance = nanoflann::L2_Simple_Adaptor<double, Points, double, Number>;

  explicit NanoflannTree(std::span<const Eigen::Vector3d> positions) : points{positions} {}

  Points points;
  nanoflann::KDTreeSingleIndexAdaptor<Distance, Points, 3, Number> index{
      3, points, nanoflann::KDTreeSingleIndexAdaptorParams(12)};
};

}  // namespace lacuna
