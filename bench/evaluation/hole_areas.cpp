// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/hole_areas.hpp"

#include "bench/evaluation/loop_kind.hpp"
#include "bench/evaluation/triangle_pieces.hpp"
#include "io/lids/triangulate_polygon.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace lacuna::evaluation {
namespace {

using Points = std::vector<Eigen::Vector3d>;

struct Pieces {
  Points centroids;
  std::vector<double> areas;
};

void add_pieces(const Points& loop, double longest_edge, Pieces& pieces) {
  const bool is_finite = std::all_of(loop.begin(), loop.end(), [](const auto& p) { return p.allFinite(); });
  if (loop.size() < 3 || !is_finite) return;
  const io::LidMesh lid = io::triangulate_polygon(loop);
  for (const auto& [a, b, c] : lid.triangles) {
    visit_pieces(
        {lid.vertices[a], lid.vertices[b], lid.vertices[c]}, longest_edge,
        [](const Corners&) { return false; },
        [&](const Corners& piece) {
          pieces.centroids.push_back(centroid_of(piece));
          pieces.areas.push_back(area_of(piece));
        });
  }
}

double area_of(const Pieces& pieces) {
  return std::accumulate(pieces.areas.begin(), pieces.areas.end(), 0.0);
}

// Returns the area of the pieces that are near one of the others.
double area_near(const Pieces& pieces, std::span<const Eigen::Vector3d> others, double buffer) {
  const PointTree tree(others);
  double area = 0;
  for (std::size_t i = 0; i < pieces.areas.size(); ++i) {
    if (tree.nearest_distance(pieces.centroids[i]) <= buffer) area += pieces.areas[i];
  }
  return area;
}

}  // namespace

HoleAreas compare_areas(std::span<const LoopIds> loops, const Truth& truth,
                        std::span<const TrueMatch> matches, double buffer) {
  if (!(buffer > 0)) return {};
  Pieces counting, others, found;
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    if (!truth.hole_widths[i]) continue;  // an outer curve
    Points loop;
    for (const auto& edge : truth.loops[i].edges) loop.push_back(truth.positions[edge[0]]);
    add_pieces(loop, buffer / 2, matches[i].counts ? counting : others);
  }
  const Points points = distinct_points(truth.positions, truth.stand_ins);
  const PointTree tree(points);
  for (const LoopIds& ids : loops) {
    if (kind_of(ids, truth.positions, points, tree) != LoopKind::kHole) continue;
    Points loop;
    for (const std::uint64_t id : ids) loop.push_back(truth.positions[id]);
    add_pieces(loop, buffer / 2, found);
  }
  HoleAreas areas{.truth = area_of(counting),
                  .covered = area_near(counting, found.centroids, buffer),
                  .found = area_of(found)};
  Points all = std::move(counting.centroids);
  all.insert(all.end(), others.centroids.begin(), others.centroids.end());
  areas.right = area_near(found, all, buffer);
  return areas;
}

}  // namespace lacuna::evaluation
