// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/inside_places.hpp"

#include "io/explain/lids/triangulate_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lacuna::io {
namespace {

constexpr std::uint64_t kMostCorners = 64;  // of a loop that is triangulated
constexpr std::uint64_t kMostIslandCorners = 16;
constexpr double kPlaces = 256;  // of a hole, at least

// Spreads places evenly over the triangles, by the sequence R2 (Roberts, 2018).
std::vector<InnerSample> places_inside(const LidMesh& mesh) {
  const double spacing = area(mesh) / kPlaces;
  std::vector<InnerSample> places;
  if (!(spacing > 0)) return places;
  for (const LidTriangle& triangle : mesh.triangles) {
    const Eigen::Vector3d vector = area_vector(mesh, triangle);
    const double size = vector.norm();
    if (!(size > 0)) continue;
    const auto count = static_cast<std::size_t>(std::ceil(size / spacing));
    const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
    const Eigen::Vector3d to_b = mesh.vertices[triangle[1]] - a, to_c = mesh.vertices[triangle[2]] - a;
    for (std::size_t i = 1; i <= count; ++i) {
      const double n = static_cast<double>(i);
      double u = 0.5 + n * 0.7548776662466927, v = 0.5 + n * 0.5698402909980532;
      u -= std::floor(u);
      v -= std::floor(v);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      places.push_back({a + u * to_b + v * to_c, vector / size, size / static_cast<double>(count)});
    }
  }
  return places;
}

// Returns `most` points of the loop at even steps, or all if it has fewer.
std::vector<Eigen::Vector3d> some_corners(const Detection& detection, const InnerRing& loop,
                                          std::uint64_t most) {
  const std::uint64_t count = std::min(loop.points, most);
  std::vector<Eigen::Vector3d> corners;
  std::uint64_t at = 0;
  detection.for_each_loop_point(loop.loop, [&](const LoopPoint& point) {
    if (corners.size() < count && at++ >= corners.size() * loop.points / count)
      corners.push_back(point.position());
  });
  return corners;
}

}  // namespace

std::vector<InnerSample> inside_places(const Detection& detection, std::size_t loop) {
  const std::span<const InnerRing> islands = detection.inner_rings_of(loop);
  std::vector<Eigen::Vector3d> corners =
      some_corners(detection, {loop, detection.loops[loop].points}, kMostCorners);
  if (islands.empty() || corners.size() < 3) return inside_places(corners);
  std::vector<std::size_t> sizes = {corners.size()};
  for (const InnerRing& island : islands.first(std::min(islands.size(), kMostIslands))) {
    const std::vector<Eigen::Vector3d> ring = some_corners(detection, island, kMostIslandCorners);
    corners.insert(corners.end(), ring.begin(), ring.end());
    sizes.push_back(ring.size());
  }
  std::vector<InnerSample> places = places_inside(triangulate_rings(corners, sizes));
  return places.empty() ? inside_places(std::span(corners).first(sizes[0])) : places;
}

std::vector<InnerSample> inside_places(std::span<const Eigen::Vector3d> loop) {
  const std::size_t count = std::min<std::size_t>(loop.size(), kMostCorners);
  std::vector<Eigen::Vector3d> corners;
  for (std::size_t i = 0; i < count; ++i) corners.push_back(loop[i * loop.size() / count]);
  return count < 3 ? std::vector<InnerSample>() : places_inside(triangulate_polygon(corners));
}

}  // namespace lacuna::io
