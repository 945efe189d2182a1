// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/unsampled.hpp"

#include "bench/evaluation/outline.hpp"
#include "bench/evaluation/spacing.hpp"
#include "bench/evaluation/triangle_pieces.hpp"
#include "tools/matching/edge_tree.hpp"
#include "tools/matching/point_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace lacuna::evaluation {
using namespace matching;

namespace {

using Points = std::vector<Eigen::Vector3d>;

// Spacings. A ring of 9 points, one spacing apart, has nearly this radius.
constexpr double kEmptyRadius = 1.5;
constexpr double kLongestEdge = 0.5;

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
    const auto is_far = [&](const Corners& part) {
      const Eigen::Vector3d centroid = centroid_of(part);
      double extent = 0;
      for (const Eigen::Vector3d& corner : part) extent = std::max(extent, (corner - centroid).stableNorm());
      return !(near.nearest_distance(centroid) <= reach + extent);
    };
    visit_pieces(corners, kLongestEdge * spacing, is_far, [&](const Corners& piece) {
      const Eigen::Vector3d place = centroid_of(piece);
      const double radius = scan.nearest_distance(place);
      if (radius > kEmptyRadius * spacing) places.push_back({place, radius});
    });
  }
  return places;
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

  const Points points = distinct_points(sampling.positions, sampling.stand_ins);
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
