// SPDX-License-Identifier: Apache-2.0
// Divides triangles into small pieces, so that a surface becomes finitely many places.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <Eigen/Geometry>

namespace lacuna::evaluation {

using Corners = std::array<Eigen::Vector3d, 3>;

inline Eigen::Vector3d centroid_of(const Corners& corners) {
  return (corners[0] + corners[1] + corners[2]) / 3;
}

inline double area_of(const Corners& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2;
}

// Halves the triangle at the middle of its longest edge until no edge is longer than `longest_edge`. Calls
// `visit` with the corners of each piece. A part for which `skip` is true is left out.
template <class Skip, class Visit>
void visit_pieces(const Corners& corners, double longest_edge, const Skip& skip, const Visit& visit) {
  if (skip(corners)) return;
  double longest = -1;
  std::size_t apex = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double opposite = (corners[(i + 1) % 3] - corners[(i + 2) % 3]).stableNorm();
    if (opposite > longest) {
      longest = opposite;
      apex = i;
    }
  }
  const Eigen::Vector3d &a = corners[apex], &b = corners[(apex + 1) % 3], &c = corners[(apex + 2) % 3];
  const Eigen::Vector3d middle = (b + c) / 2;
  // Where coordinates are hardly finer than the spacing, the middle may be rounded to an end.
  const double half = std::max((middle - b).stableNorm(), (middle - c).stableNorm());
  if (longest <= longest_edge || half > 0.75 * longest) return visit(corners);
  visit_pieces({a, b, middle}, longest_edge, skip, visit);
  visit_pieces({a, middle, c}, longest_edge, skip, visit);
}

}  // namespace lacuna::evaluation
