// SPDX-License-Identifier: Apache-2.0
// The plane through a loop's centroid.
#pragma once

#include "engine/model/loop.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lacuna {

// Its first axis is `right`, its third one the loop's normal.
class LoopPlane {
 public:
  LoopPlane(const Eigen::Vector3d& centroid, const Eigen::Vector3d& normal, const Eigen::Vector3d& right)
      : origin_(centroid) {
    axes_ << right, normal.cross(right), normal;
  }
  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const { return axes_.transpose() * (p - origin_); }
  Eigen::Vector3d point_at(const Eigen::Vector3d& in_plane) const { return origin_ + axes_ * in_plane; }

 private:
  Eigen::Vector3d origin_;
  Eigen::Matrix3d axes_;
};

inline LoopPlane plane_of(const LoopMeasures& loop) {
  return {loop.centroid, loop.normal, loop.normal.unitOrthogonal()};
}

}  // namespace lacuna
