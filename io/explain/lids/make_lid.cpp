// SPDX-License-Identifier: Apache-2.0
#include "io/explain/lids/make_lid.hpp"

#include "io/explain/lids/triangulate_polygon.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {
namespace {

Lid without_lid(std::string reason) {
  return {.mesh = {}, .area = 0, .left_out = std::move(reason)};
}

// Whether each edge is on at most two triangles, once in each direction.
bool is_surface(const LidMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const LidTriangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(triangle[i], triangle[(i + 1) % 3]);
  }
  std::ranges::sort(edges);
  return std::ranges::adjacent_find(edges) == edges.end();
}

double square_of_extent(std::span<const Eigen::Vector3d> points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  return box.diagonal().squaredNorm();
}

}  // namespace

std::string left_out(std::uint64_t points, std::size_t islands) {
  if (points < 3) return "fewer than 3 points";
  if (points > kMostLoopPoints) return "more than " + std::to_string(kMostLoopPoints) + " points";
  if (islands > kMostIslands) return "more than " + std::to_string(kMostIslands) + " islands in it";
  return {};
}

Lid make_lid(const Loop& loop, std::span<const Loop> islands) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::size_t> sizes;
  const auto add = [&](const Loop& ring) {
    for (const LoopPoint& point : ring) points.push_back(point.position());
    sizes.push_back(ring.size());
  };
  add(loop);
  for (const Loop& island : islands) add(island);
  if (std::string reason = left_out(points.size(), islands.size()); !reason.empty())
    return without_lid(std::move(reason));
  LidMesh mesh = triangulate_rings(points, sizes);
  if (mesh.triangles.empty() || !is_surface(mesh)) return without_lid("no surface leaves its islands open");
  constexpr double kNoArea = 1e-12;  // of the square of the extent: rounding
  const double size = area(mesh);
  if (!(size > kNoArea * square_of_extent(points))) return without_lid("all points in one line");
  return {.mesh = std::move(mesh), .area = size, .left_out = {}};
}

}  // namespace lacuna::io
