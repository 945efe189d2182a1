// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/unsampled.hpp"

#include "bench/evaluation/outline.hpp"
#include "bench/evaluation/spacing.hpp"
#include "tools/matching/edge_tree.hpp"
#include "tools/matching/point_tree.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

namespace lacuna::evaluation {
using namespace matching;

namespace {

using Points = std::vector<Eigen::Vector3d>;
using Corners = std::array<Eigen::Vector3d, 3>;

// Spacings. A ring of 9 points, one spacing apart, has nearly this radius.
constexpr double kEmptyRadius = 1.5;
constexpr double kLongestEdge = 0.5;

// Calls `visit` with all places of the triangle that are within `radius` of the tree's points, and perhaps
// with others.
template <class Visit>
void visit_places(const Corners& corners, double longest_edge, double radius, const PointTree& near,
                  const Visit& visit) {
  const Eigen::Vector3d centroid = (corners[0] + corners[1] + corners[2]) / 3;
  double extent = 0, longest = -1;
  std::size_t apex = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    extent = std::max(extent, (corners[i] - centroid).stableNorm());
    const double opposite = (corners[(i + 1) % 3] - corners[(i + 2) % 3]).stableNorm();
    if (opposite > longest) std::tie(longest, apex) = std::pair(opposite, i);
  }
  if (!(near.nearest_distance(centroid) <= radius + extent)) return;
  const Eigen::Vector3d &a = corners[apex], &b = corners[(apex + 1) % 3], &c = corners[(apex + 2) % 3];
  const Eigen::Vector3d middle = (b + c) / 2;
  // Where coordinates are hardly finer than the spacing, the middle may be rounded to an end.
  const double half = std::max((middle - b).stableNorm(), (middle - c).stableNorm());
  if (longest <= longest_edge || half > 0.75 * longest) return visit(centroid);
  visit_places({a, b, middle}, longest_edge, radius, near, visit);
  visit_places({a, middle, c}, longest_edge, radius, near, visit);
}

// A ball around a place, up to the nearest point of the scan.
struct EmptyBall {
  Eigen::Vector3d middle;
  double radius;
};

// Returns the places of at least the least radius, within `reach` of a loop's point, and perhaps others.
std::vector<EmptyBall> empty_places(const Surface& surface, const PointTree& scan, double spacing,
                                    const PointTree& near, double reach) {
  std::vector<EmptyBall> places;
  for (const Triangle& triangle : surface.triangles) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = surface.positions[triangle[i]];
    if (!std::all_of(corners.begin(), corners.end(), [](const auto& corner) { return corner.allFinite(); })) {
      continue;
    }
    visit_places(corners, kLongestEdge * spacing, reach, near, [&](const Eigen::Vector3d& place) {
      const double radius = scan.nearest_distance(place);
      if (radius > kEmptyRadius * spacing) places.push_back({place, radius});
    });
  }
  return places;
}

Points distinct_points(const Sampling& sampling) {
  Points points;
  for (std::size_t id = 0; id < sampling.positions.size(); ++id) {
    if (sampling.stand_ins[id] == id && sampling.positions[id].allFinite()) {
      points.push_back(sampling.positions[id]);
    }
  }
  return points;
}

}  // namespace

std::vector<std::vector<bool>> points_at_unsampled(std::span<const LoopIds> loops, const Surface& surface,
                                                   const Sampling& sampling) {
  std::vector<std::vector<bool>> result;
  Points loop_points;
  for (const LoopIds& loop : loops) {
    result.emplace_back(loop.size());
    for (const std::uint64_t id : loop) {
      if (sampling.positions[id].allFinite()) loop_points.push_back(sampling.positions[id]);
    }
  }
  if (loop_points.empty() || !(sampling.spacing > 0)) return result;

  const Points points = distinct_points(sampling);
  const PointTree scan(points);
  const auto empty_radius = [&](const Eigen::Vector3d& point) {
    return kEmptyRadius * std::max(sampling.spacing, spacing_at(point, scan));
  };
  double reach = 0;
  for (const Eigen::Vector3d& point : loop_points) reach = std::max(reach, 2 * empty_radius(point));
  const std::vector<EmptyBall> places =
      empty_places(surface, scan, sampling.spacing, PointTree(loop_points), reach);
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < places.size(); ++i) segments.push_back({places[i].middle, places[i].middle, i});
  const EdgeTree tree(std::move(segments));

  std::vector<std::size_t> near;
  for (std::size_t loop = 0; loop < loops.size(); ++loop) {
    Points polygon;
    for (const std::uint64_t id : loops[loop]) polygon.push_back(sampling.positions[id]);
    const Outline outline(polygon);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      if (!polygon[i].allFinite()) continue;
      const double radius = empty_radius(polygon[i]);
      tree.owners_within(polygon[i], 2 * radius, near);
      result[loop][i] = std::any_of(near.begin(), near.end(), [&](std::size_t place) {
        return places[place].radius > radius && outline.contains(places[place].middle);
      });
    }
  }
  return result;
}

}  // namespace lacuna::evaluation
