// SPDX-License-Identifier: Apache-2.0
#include "io/lids/self_intersections.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna::io {
namespace {

using Triangle3 = std::array<Eigen::Vector3d, 3>;
using Triangle2 = std::array<Eigen::Vector2d, 3>;

// Whether visit(i, j) is true for any pair of boxes that overlap. Boxes are passed in order along the axis
// on which they extend the farthest together.
template <class Box, class Visit>
bool any_overlap(const std::vector<Box>& boxes, Visit&& visit) {
  Box all;
  for (const Box& box : boxes) all.extend(box);
  Eigen::Index axis = 0;
  all.sizes().maxCoeff(&axis);
  std::vector<std::size_t> order(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(boxes[a].min()[axis], a) < std::pair(boxes[b].min()[axis], b);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      if (boxes[order[j]].min()[axis] > boxes[order[i]].max()[axis]) break;
      if (boxes[order[i]].intersects(boxes[order[j]]) && visit(order[i], order[j])) return true;
    }
  }
  return false;
}

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool do_cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
              const Eigen::Vector2d& d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

bool do_touch(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
              const Eigen::Vector2d& d) {
  return turn(a, b, c) * turn(a, b, d) <= 0 && turn(c, d, a) * turn(c, d, b) <= 0;
}

bool is_inside(const Eigen::Vector2d& p, const Triangle2& triangle) {
  int positive = 0, negative = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = turn(triangle[i], triangle[(i + 1) % 3], p);
    positive += side > 0;
    negative += side < 0;
  }
  return positive == 3 || negative == 3;
}

bool do_overlap(const Triangle2& a, const Triangle2& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (do_cross(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3])) return true;
    }
  }
  return is_inside(a[0], b) || is_inside(b[0], a);
}

Triangle2 without_axis(const Triangle3& triangle, Eigen::Index axis) {
  Triangle2 flat;
  for (std::size_t i = 0; i < 3; ++i) flat[i] = {triangle[i][(axis + 1) % 3], triangle[i][(axis + 2) % 3]};
  return flat;
}

// Returns signed distances of the corners of `b` from the plane of `a`, times its doubled area; 0 within
// rounding.
std::array<double, 3> sides(const Triangle3& a, const Triangle3& b) {
  const Eigen::Vector3d normal = (a[1] - a[0]).cross(a[2] - a[0]);
  std::array<double, 3> sides;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d to = b[i] - a[0];
    constexpr double kRounding = 1e-9;
    const double side = normal.dot(to);
    sides[i] = std::abs(side) <= kRounding * normal.norm() * to.norm() ? 0 : side;
  }
  return sides;
}

// Whether the edge from p to q passes through the inside of the triangle; their sides are opposite.
bool passes(const Triangle3& triangle, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  const Eigen::Vector3d along = q - p;
  int positive = 0, negative = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double volume = along.dot((triangle[i] - p).cross(triangle[(i + 1) % 3] - p));
    positive += volume > 0;
    negative += volume < 0;
  }
  return positive == 3 || negative == 3;
}

bool edge_passes(const Triangle3& of, const Triangle3& through, const std::array<double, 3>& sides) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (sides[i] * sides[next] < 0 && passes(through, of[i], of[next])) return true;
  }
  return false;
}

bool do_intersect(const Triangle3& a, const Triangle3& b) {
  const std::array<double, 3> of_b = sides(a, b);
  if (of_b[0] == 0 && of_b[1] == 0 && of_b[2] == 0) {
    Eigen::Index axis = 0;
    (a[1] - a[0]).cross(a[2] - a[0]).cwiseAbs().maxCoeff(&axis);
    return do_overlap(without_axis(a, axis), without_axis(b, axis));
  }
  return edge_passes(b, a, of_b) || edge_passes(a, b, sides(b, a));
}

std::size_t common_vertices(const LidTriangle& a, const LidTriangle& b) {
  std::size_t count = 0;
  for (const std::uint32_t vertex : a)
    count += static_cast<std::size_t>(std::count(b.begin(), b.end(), vertex));
  return count;
}

// Whether two triangles on one edge lie in one plane, on the same side of it.
bool are_folded(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  constexpr double kFolded = 1 - 1e-9;
  return a.dot(b) < -kFolded * a.norm() * b.norm();
}

}  // namespace

bool crosses_itself(std::span<const Eigen::Vector3d> loop) {
  const std::size_t n = loop.size();
  Eigen::Vector3d normal(0, 0, 0);
  for (std::size_t i = 0; i < n; ++i) normal += (loop[i] - loop[0]).cross(loop[(i + 1) % n] - loop[0]);
  if (!(normal.norm() > 0)) return true;
  const Eigen::Vector3d right = normal.unitOrthogonal(), up = normal.normalized().cross(right);
  std::vector<Eigen::Vector2d> flat;
  for (const Eigen::Vector3d& point : loop) flat.emplace_back(right.dot(point), up.dot(point));
  std::vector<Eigen::AlignedBox2d> boxes(n);
  for (std::size_t i = 0; i < n; ++i) boxes[i].extend(flat[i]).extend(flat[(i + 1) % n]);
  return any_overlap(boxes, [&](std::size_t i, std::size_t j) {
    if ((i + 1) % n == j || (j + 1) % n == i) return false;
    return do_touch(flat[i], flat[(i + 1) % n], flat[j], flat[(j + 1) % n]);
  });
}

bool has_intersections(const LidMesh& mesh) {
  const auto corners = [&](std::size_t t) {
    Triangle3 corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = mesh.vertices[mesh.triangles[t][i]];
    return corners;
  };
  std::vector<Eigen::AlignedBox3d> boxes(mesh.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const Eigen::Vector3d& corner : corners(t)) boxes[t].extend(corner);
  }
  return any_overlap(boxes, [&](std::size_t a, std::size_t b) {
    const LidTriangle &left = mesh.triangles[a], &right = mesh.triangles[b];
    switch (common_vertices(left, right)) {
      case 0:
        return do_intersect(corners(a), corners(b));
      case 2:
        return are_folded(area_vector(mesh, left), area_vector(mesh, right));
      default:
        return false;
    }
  });
}

}  // namespace lacuna::io
