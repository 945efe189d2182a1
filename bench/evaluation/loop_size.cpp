// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loop_size.hpp"

#include "engine/loops/measure_loop.hpp"

#include <Eigen/Geometry>

namespace lacuna::evaluation {
namespace {

Eigen::Vector3d mean_of(std::span<const std::uint64_t> ids, std::span<const Eigen::Vector3d> positions) {
  if (ids.empty()) return {0, 0, 0};
  const Eigen::Vector3d first = positions[ids.front()];  // georeferenced: keep the digits
  Eigen::Vector3d sum(0, 0, 0);
  for (const std::uint64_t id : ids) sum += positions[id] - first;
  return first + sum / static_cast<double>(ids.size());
}

}  // namespace

LoopSize size_of(const TrueLoop& loop, std::span<const Eigen::Vector3d> positions) {
  LoopSize size{.centre = mean_of(loop.vertices, positions)};
  Eigen::Vector3d area(0, 0, 0);
  Loop along;  // the vertices in order, which makes the diameter fast
  const auto add = [&](std::uint64_t id) { along.push_back({ScanPoint::at(positions[id], PointId{id})}); };
  for (const auto& [a, b] : loop.edges) {
    size.perimeter += (positions[a] - positions[b]).norm();
    area += (positions[a] - size.centre).cross(positions[b] - size.centre) / 2;
    add(a);
  }
  if (!along.empty()) {
    add(loop.edges.back()[1]);  // the first one again, but for an open loop
    size.diameter = diameter(along);
  }
  size.area = area.norm();
  return size;
}

LoopSize size_of(const LoopIds& loop, std::span<const Eigen::Vector3d> positions) {
  TrueLoop closed{.vertices = loop};
  for (std::size_t i = 0; i < loop.size(); ++i)
    closed.edges.push_back({loop[i], loop[i + 1 < loop.size() ? i + 1 : 0]});
  return size_of(closed, positions);
}

}  // namespace lacuna::evaluation
