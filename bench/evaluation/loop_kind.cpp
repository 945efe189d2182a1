// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loop_kind.hpp"

#include "engine/loops/measure_loop.hpp"

namespace lacuna::evaluation {
namespace {

constexpr std::size_t kNeighbours = 15;  // as in `detect`

Eigen::Vector3d towards_surface(const Eigen::Vector3d& place, std::span<const Eigen::Vector3d> points,
                                const PointTree& tree) {
  Eigen::Vector3d sum(0, 0, 0);
  const std::vector<std::size_t> nearest = tree.nearest_points(place, kNeighbours + 1);
  for (const std::size_t point : nearest) sum += points[point] - place;  // of the place itself: 0
  return sum / static_cast<double>(kNeighbours);
}

}  // namespace

std::optional<LoopKind> kind_of(const LoopIds& loop, std::span<const Eigen::Vector3d> positions,
                                std::span<const Eigen::Vector3d> points, const PointTree& tree) {
  if (loop.size() < 3) return std::nullopt;
  Loop polygon;
  for (const std::uint64_t id : loop) {
    if (!positions[id].allFinite()) return std::nullopt;
    const Eigen::Vector3f surface = towards_surface(positions[id], points, tree).cast<float>();
    polygon.push_back({ScanPoint::at(positions[id], PointId{id}), {surface.x(), surface.y(), surface.z()}});
  }
  return measure_loop(polygon, 1).kind;
}

}  // namespace lacuna::evaluation
