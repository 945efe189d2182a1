// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loop_size.hpp"

#include "engine/loops/measure_loop.hpp"

namespace lacuna::evaluation {
using namespace io;

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
  LoopSize size;
  Loop along;  // both ends of each edge: edges that follow each other are near each other, and diameter is
               // then fast
  for (const auto& [a, b] : loop.edges) {
    size.perimeter += (positions[a] - positions[b]).norm();
    along.push_back({ScanPoint::at(positions[a], PointId{a})});
    along.push_back({ScanPoint::at(positions[b], PointId{b})});
  }
  if (!along.empty()) size.diameter = diameter(along);
  size.centre = mean_of(loop.vertices, positions);
  return size;
}

LoopSize size_of(const LoopIds& loop, std::span<const Eigen::Vector3d> positions) {
  LoopSize size;
  Loop along;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::uint64_t next = loop[i + 1 < loop.size() ? i + 1 : 0];
    size.perimeter += (positions[loop[i]] - positions[next]).norm();
    along.push_back({ScanPoint::at(positions[loop[i]], PointId{loop[i]})});
  }
  if (!along.empty()) size.diameter = diameter(along);
  size.centre = mean_of(loop, positions);
  return size;
}

}  // namespace lacuna::evaluation
