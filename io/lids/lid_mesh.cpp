// SPDX-License-Identifier: Apache-2.0
#include "io/lids/lid_mesh.hpp"

#include <algorithm>
#include <tuple>

#include <Eigen/Geometry>

namespace lacuna::io {

Eigen::Vector3d area_vector(const LidMesh& mesh, const LidTriangle& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  return (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a) / 2;
}

double area(const LidMesh& mesh) {
  double sum = 0;
  for (const LidTriangle& triangle : mesh.triangles) sum += area_vector(mesh, triangle).norm();
  return sum;
}

LidNeighbours neighbours(const LidMesh& mesh) {
  struct Side {
    std::uint32_t low, high, triangle, corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = mesh.triangles[t][(corner + 1) % 3], b = mesh.triangles[t][(corner + 2) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, corner});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  LidNeighbours across(mesh.triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &a = sides[i], &b = sides[i + 1];
    if (a.low != b.low || a.high != b.high) continue;
    across[a.triangle][a.corner] = b.triangle;
    across[b.triangle][b.corner] = a.triangle;
  }
  return across;
}

std::vector<std::uint32_t> next_on_loops(const LidMesh& mesh) {
  std::vector<std::uint32_t> next(mesh.loop_points);
  const LidNeighbours across = neighbours(mesh);
  for (std::size_t t = 0; t < across.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (across[t][corner] != kNoTriangle) continue;
      next[mesh.triangles[t][(corner + 1) % 3]] = mesh.triangles[t][(corner + 2) % 3];
    }
  }
  return next;
}

}  // namespace lacuna::io
