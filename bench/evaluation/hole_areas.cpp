// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/hole_areas.hpp"

#include "bench/evaluation/loop_kind.hpp"
#include "bench/evaluation/triangle_pieces.hpp"
#include "io/lids/triangulate_polygon.hpp"
#include "tools/matching/edge_tree.hpp"
#include "tools/matching/point_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna::evaluation {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// Visits the pieces of the surface of a loop, as visit_pieces() does.
template <class Skip, class Visit>
void visit_surface(const Points& loop, double longest_edge, const Skip& skip, const Visit& visit) {
  const bool is_finite = std::all_of(loop.begin(), loop.end(), [](const auto& p) { return p.allFinite(); });
  if (loop.size() < 3 || !is_finite) return;
  const io::LidMesh lid = io::triangulate_polygon(loop);
  for (const auto& [a, b, c] : lid.triangles)
    visit_pieces({lid.vertices[a], lid.vertices[b], lid.vertices[c]}, longest_edge, skip, visit);
}

// The surfaces of the true holes. Those of found holes pass by piece by piece, however many they are.
class TrueSurfaces {
 public:
  TrueSurfaces(const Truth& truth, std::span<const TrueMatch> matches, double buffer) : buffer_(buffer) {
    for (const bool counts : {true, false}) {
      for (std::size_t i = 0; i < truth.loops.size(); ++i) {
        if (truth.hole_widths[i] && matches[i].counts == counts) add(truth.loops[i], truth.positions);
      }
      if (counts) covered_.resize(areas_.size());
    }
    std::vector<Segment> places;
    for (std::size_t i = 0; i < covered_.size(); ++i) places.push_back({centroids_[i], centroids_[i], i});
    counting_.emplace(std::move(places));
    all_.emplace(centroids_);
  }

  void take_found(const Points& loop) {
    const auto is_far = [&](const Corners& part) {
      double extent = 0;
      const Eigen::Vector3d centroid = centroid_of(part);
      for (const Eigen::Vector3d& corner : part) extent = std::max(extent, (corner - centroid).stableNorm());
      if (all_->nearest_distance(centroid) <= buffer_ + extent) return false;
      found_ += area_of(part);
      return true;
    };
    visit_surface(loop, buffer_ / 2, is_far, [&](const Corners& piece) {
      found_ += area_of(piece);
      const Eigen::Vector3d centroid = centroid_of(piece);
      if (all_->nearest_distance(centroid) > buffer_) return;
      right_ += area_of(piece);
      counting_->owners_within(centroid, buffer_, near_);
      for (const std::size_t of : near_) covered_[of] = true;
    });
  }

  HoleAreas areas() const {
    HoleAreas areas{.found = found_, .right = right_};
    for (std::size_t i = 0; i < covered_.size(); ++i) {
      areas.truth += areas_[i];
      if (covered_[i]) areas.covered += areas_[i];
    }
    return areas;
  }

 private:
  void add(const TrueLoop& hole, std::span<const Eigen::Vector3d> positions) {
    Points loop;
    for (const auto& edge : hole.edges) loop.push_back(positions[edge[0]]);
    visit_surface(
        loop, buffer_ / 2, [](const Corners&) { return false; },
        [&](const Corners& piece) {
          centroids_.push_back(centroid_of(piece));
          areas_.push_back(area_of(piece));
        });
  }

  double buffer_;
  Points centroids_;  // of the pieces; those of the holes that count come first
  std::vector<double> areas_;
  std::vector<bool> covered_;  // of the pieces that count
  std::optional<EdgeTree> counting_;
  std::optional<PointTree> all_;
  std::vector<std::size_t> near_;
  double found_ = 0, right_ = 0;
};

}  // namespace

HoleAreas compare_areas(std::span<const LoopIds> loops, const Truth& truth,
                        std::span<const TrueMatch> matches, double buffer) {
  if (!(buffer > 0)) return {};
  TrueSurfaces surfaces(truth, matches, buffer);
  const Points points = distinct_points(truth.positions, truth.stand_ins);
  const PointTree tree(points);
  for (const LoopIds& ids : loops) {
    if (kind_of(ids, truth.positions, points, tree) != LoopKind::kHole) continue;
    Points loop;
    for (const std::uint64_t id : ids) loop.push_back(truth.positions[id]);
    surfaces.take_found(loop);
  }
  return surfaces.areas();
}

}  // namespace lacuna::evaluation
