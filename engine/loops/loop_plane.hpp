// SPDX-License-Identifier: Apache-2.0
// The plane through a loop's centroid, and places of the polygon that the loop is in it.
#pragma once

#include "engine/model/loop.hpp"

#include <cstddef>
#include <span>
#include <vector>

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

// Whether an odd number of edges lies to the right of the place. `polygon`: closed, at least one point, with
// its coordinates at [0] and [1].
template <class Point>
bool is_inside(std::span<const Point> polygon, const Eigen::Vector2d& place) {
  bool inside = false;
  for (std::size_t i = 0, before = polygon.size() - 1; i < polygon.size(); before = i++) {
    const Point &a = polygon[before], &b = polygon[i];
    if ((a[1] > place.y()) != (b[1] > place.y()) &&
        place.x() < a[0] + (place.y() - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
      inside = !inside;
  }
  return inside;
}

// Returns `most` places within the polygon, or fewer where it fills less than a sixteenth of its box. They
// follow the additive recurrence with the plastic number (Roberts, 2018). Cost: edges times places.
template <class Point>
std::vector<Eigen::Vector2d> places_within(std::span<const Point> polygon, std::size_t most) {
  constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;
  Eigen::AlignedBox2d box;
  for (const Point& p : polygon) box.extend(Eigen::Vector2d(p[0], p[1]));
  std::vector<Eigen::Vector2d> places;
  Eigen::Vector2d part(0.5, 0.5);
  for (std::size_t i = 0; i < 16 * most && places.size() < most; ++i) {
    part += Eigen::Vector2d(kFirst, kSecond);
    part -= part.array().floor().matrix();
    const Eigen::Vector2d place = box.min() + part.cwiseProduct(box.sizes());
    if (is_inside(polygon, place)) places.push_back(place);
  }
  return places;
}

}  // namespace lacuna
