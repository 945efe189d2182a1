// SPDX-License-Identifier: Apache-2.0
// measures: how far apart the points of a scan are, and how large its loops.
//
// Idea: the truth knows places alone. So the spacing of a place is measured at its nearest points. The size,
// kind and width of a loop follow, by the rules for found loops.
//
// Source: docs/evaluate.md. Cost: log n for a place, and n log n for the tree of the points.
#include "bench/evaluation/evaluation.hpp"
#include "engine/loops/measure_loops.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna::evaluation {

namespace {

// Returns the mean distance to the 4 nearest other points, or to all if there are fewer; 0 for a single
// point. The place is a point of the tree, whose points are distinct.
double spacing_at(const Eigen::Vector3d& point, const PointTree& tree) {
  constexpr std::size_t kNeighbours = 4;
  // The point itself is the first.
  const std::vector<double> distances = tree.nearest_distances(point, kNeighbours + 1);
  if (distances.size() < 2) return 0;
  return std::accumulate(distances.begin(), distances.end(), 0.) / static_cast<double>(distances.size() - 1);
}

}  // namespace

double spacing_of_place(const Eigen::Vector3d& place, const PointTree& tree) {
  constexpr std::size_t kAround = 32;
  const std::vector<double> distances =
      tree.nearest_distances(place, kAround + 1);  // the first is the point's own
  if (distances.size() <= kAround) return 0;
  return distances.back() * std::sqrt(std::numbers::pi / kAround);  // a disc of as many squares
}

double median_spacing(std::span<const Eigen::Vector3d> points, const PointTree& tree) {
  if (points.size() < 2) return 0;
  // More points hardly move a median, and each takes microseconds.
  constexpr std::size_t kMostTaken = 1 << 17;
  std::vector<double> spacings;
  const std::size_t step = (points.size() - 1) / kMostTaken + 1;
  for (std::size_t i = 0; i < points.size(); i += step) spacings.push_back(spacing_at(points[i], tree));
  return median(std::move(spacings));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  if (values.empty()) return 0;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

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

namespace {

Eigen::Vector3d towards_surface(const Eigen::Vector3d& place, std::span<const Eigen::Vector3d> points,
                                const PointTree& tree) {
  constexpr std::size_t kNeighbours = 15;  // as in `detect`
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

std::optional<double> hole_width(const TrueLoop& loop, std::span<const Eigen::Vector3d> positions,
                                 std::span<const Eigen::Vector3d> points, const PointTree& tree) {
  LoopIds ids;
  for (const auto& edge : loop.edges) ids.push_back(edge[0]);
  if ((loop.kind ? loop.kind : kind_of(ids, positions, points, tree)) != LoopKind::kHole) return std::nullopt;
  double spacings = 0;
  for (const std::uint64_t id : loop.vertices) spacings += spacing_at(positions[id], tree);
  const LoopSize size = size_of(loop, positions);
  const double width =
      2 * size.area / size.perimeter / (spacings / static_cast<double>(loop.vertices.size()));
  return std::isfinite(width) ? std::optional(width) : std::nullopt;
}

HolesByWidth holes_by_width(std::span<const std::optional<double>> widths,
                            std::span<const TrueMatch> matches) {
  HolesByWidth holes;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!matches[i].counts || !widths[i]) continue;
    const auto end = std::upper_bound(kWidths.begin(), kWidths.end(), *widths[i]);
    Tally& tally = holes[static_cast<std::size_t>(end - kWidths.begin()) - 1];
    ++tally.all;
    tally.found += matches[i].found_by.has_value();
  }
  return holes;
}

}  // namespace lacuna::evaluation
