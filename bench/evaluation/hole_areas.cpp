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
  std::vector<double> reaches;  // how far from a piece others are near
};

void add_pieces(const LoopIds& ids, const Truth& truth, const MatchRule& rule, Pieces& pieces) {
  Points loop;
  double reach = 0;
  for (const std::uint64_t id : ids) {
    loop.push_back(truth.positions[id]);
    reach += rule.tolerance_at(id) / static_cast<double>(ids.size());
  }
  const bool is_finite = std::all_of(loop.begin(), loop.end(), [](const auto& p) { return p.allFinite(); });
  if (loop.size() < 3 || !is_finite) return;
  const io::LidMesh lid = io::triangulate_polygon(loop);
  for (const auto& [a, b, c] : lid.triangles) {
    visit_pieces(
        {lid.vertices[a], lid.vertices[b], lid.vertices[c]}, rule.tolerance / 2,
        [](const Corners&) { return false; },
        [&](const Corners& piece) {
          pieces.centroids.push_back(centroid_of(piece));
          pieces.areas.push_back(area_of(piece));
          pieces.reaches.push_back(reach);
        });
  }
}

double area_of(const Pieces& pieces) {
  return std::accumulate(pieces.areas.begin(), pieces.areas.end(), 0.0);
}

// Returns the area of the pieces that are near one of the others.
double area_near(const Pieces& pieces, std::span<const Eigen::Vector3d> others) {
  const PointTree tree(others);
  double area = 0;
  for (std::size_t i = 0; i < pieces.areas.size(); ++i) {
    if (tree.nearest_distance(pieces.centroids[i]) <= pieces.reaches[i]) area += pieces.areas[i];
  }
  return area;
}

}  // namespace

HoleAreas compare_areas(std::span<const LoopIds> loops, const Truth& truth,
                        std::span<const TrueMatch> matches, const MatchRule& rule) {
  if (!(rule.tolerance > 0)) return {};
  Pieces counting, others, found;
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    if (!truth.hole_widths[i]) continue;  // an outer curve
    LoopIds ids;
    for (const auto& edge : truth.loops[i].edges) ids.push_back(edge[0]);
    add_pieces(ids, truth, rule, matches[i].counts ? counting : others);
  }
  const PointTree tree(truth.points);
  for (const LoopIds& ids : loops) {
    if (kind_of(ids, truth.positions, truth.points, tree) == LoopKind::kHole)
      add_pieces(ids, truth, rule, found);
  }
  HoleAreas areas{
      .truth = area_of(counting), .covered = area_near(counting, found.centroids), .found = area_of(found)};
  Points all = std::move(counting.centroids);
  all.insert(all.end(), others.centroids.begin(), others.centroids.end());
  areas.right = area_near(found, all);
  return areas;
}

}  // namespace lacuna::evaluation
