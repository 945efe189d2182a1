// SPDX-License-Identifier: Apache-2.0
// cloud_score: the scores of `lacuna-bench score`, of one cloud and of many: per hole, per area and per
// point.
//
// Idea: the surface of a hole is the triangulation of its loop that has the least area. It is divided into
// pieces so small that the centroid of a piece decides for it. A piece counts as found, or as right, where a
// hole of the other kind is near.
//
// Source: completeness and correctness of the ISPRS benchmark on indoor modelling,
// https://www.isprs.org/resources/datasets/benchmarks/IndoorModeling/results.aspx.
// Cost: n log n for points and pieces. Memory: the pieces of the true holes.
#include "bench/evaluation/evaluation.hpp"
#include "io/explain/lids/make_lid.hpp"
#include "io/explain/matching/nearest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace lacuna::evaluation {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points points_of(const LoopIds& ids, const Truth& truth) {
  Points points;
  for (const std::uint64_t id : ids) points.push_back(truth.positions[id]);
  return points;
}

using Corners = std::array<Eigen::Vector3d, 3>;

Eigen::Vector3d centroid_of(const Corners& corners) {
  return (corners[0] + corners[1] + corners[2]) / 3;
}

double area_of(const Corners& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2;
}

// Halves the triangle at the middle of its longest edge until no edge is longer than `longest_edge`. Calls
// `visit` with the corners of each piece. A part for which `skip` is true is left out.
template <class Skip, class Visit>
void visit_pieces(const Corners& corners, double longest_edge, const Skip& skip, const Visit& visit) {
  if (skip(corners)) return;
  double longest = -1;
  std::size_t apex = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double opposite = (corners[(i + 1) % 3] - corners[(i + 2) % 3]).stableNorm();
    if (opposite > longest) {
      longest = opposite;
      apex = i;
    }
  }
  const Eigen::Vector3d &a = corners[apex], &b = corners[(apex + 1) % 3], &c = corners[(apex + 2) % 3];
  const Eigen::Vector3d middle = (b + c) / 2;
  // Where coordinates are hardly finer than the spacing, the middle may be rounded to an end.
  const double half = std::max((middle - b).stableNorm(), (middle - c).stableNorm());
  if (longest <= longest_edge || half > 0.75 * longest) return visit(corners);
  visit_pieces({a, b, middle}, longest_edge, skip, visit);
  visit_pieces({a, middle, c}, longest_edge, skip, visit);
}

// Returns how far from the surface of a hole others are near.
double reach_of(const LoopIds& ids, const MatchRule& rule) {
  double reach = 0;
  for (const std::uint64_t id : ids) reach += rule.tolerance_at(id) / static_cast<double>(ids.size());
  return reach;
}

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
  TrueSurfaces(const Truth& truth, std::span<const TrueMatch> matches, const MatchRule& rule) {
    for (const bool counts : {true, false}) {
      for (std::size_t i = 0; i < truth.loops.size(); ++i) {
        if (truth.hole_widths[i] && matches[i].counts == counts) add(truth.loops[i], truth, rule);
      }
      if (counts) covered_.resize(areas_.size());
    }
    std::map<int, std::vector<Segment>> places;  // by the octave of their reach
    for (std::size_t i = 0; i < covered_.size(); ++i)
      places[std::ilogb(reaches_[i])].push_back({centroids_[i], centroids_[i], i});
    for (auto& [octave, of_octave] : places)
      counting_.push_back({std::ldexp(1.0, octave + 1), EdgeTree(std::move(of_octave))});
    all_.emplace(centroids_);
  }

  // `reach`: of the found hole. The places of one that repeats another are not right.
  void take_found(const Points& loop, double reach, bool is_repeated) {
    const auto is_far = [&](const Corners& part) {
      double extent = 0;
      const Eigen::Vector3d centroid = centroid_of(part);
      for (const Eigen::Vector3d& corner : part) extent = std::max(extent, (corner - centroid).stableNorm());
      if (all_->nearest_distance(centroid) <= std::max(reach, farthest_) + extent) return false;
      found_ += area_of(part);
      return true;
    };
    visit_surface(loop, reach / 2, is_far, [&](const Corners& piece) {
      found_ += area_of(piece);
      const Eigen::Vector3d centroid = centroid_of(piece);
      if (!is_repeated && all_->nearest_distance(centroid) <= reach) right_ += area_of(piece);
      for (const Counting& counting : counting_) {
        counting.tree.owners_within(centroid, counting.reach, near_);
        for (const std::size_t of : near_) {
          if ((centroids_[of] - centroid).stableNorm() <= reaches_[of]) covered_[of] = true;
        }
      }
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
  void add(const TrueLoop& hole, const Truth& truth, const MatchRule& rule) {
    LoopIds ids;
    for (const auto& edge : hole.edges) ids.push_back(edge[0]);
    const double reach = reach_of(ids, rule);
    farthest_ = std::max(farthest_, reach);
    visit_surface(
        points_of(ids, truth), reach / 2, [](const Corners&) { return false; },
        [&](const Corners& piece) {
          centroids_.push_back(centroid_of(piece));
          areas_.push_back(area_of(piece));
          reaches_.push_back(reach);
        });
  }

  // Pieces that count, of holes whose reaches are within an octave below this one.
  struct Counting {
    double reach;
    EdgeTree tree;
  };

  double farthest_ = 0;
  Points centroids_;  // of the pieces; those of the holes that count come first
  std::vector<double> areas_, reaches_;
  std::vector<bool> covered_;  // of the pieces that count
  std::vector<Counting> counting_;
  std::optional<PointTree> all_;
  std::vector<std::size_t> near_;
  double found_ = 0, right_ = 0;
};

// Outer curves have no surface, and neither
// has a loop with a point that is not finite. Loops along steps of density take no part. A loop that repeats
// another has no right place. Places of a hole are near others within the mean tolerance of the hole's
// points. Pieces have edges of at most half of that tolerance. With a tolerance of 0, all areas are 0.
HoleAreas compare_areas(std::span<const LoopIds> loops, const Truth& truth, const LoopAccuracy& accuracy,
                        const MatchRule& rule) {
  if (!(rule.tolerance > 0)) return {};
  TrueSurfaces surfaces(truth, accuracy.true_loops, rule);
  const PointTree tree(truth.points);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const EdgeDecision verdict = accuracy.loops[i].verdict;
    if (verdict == EdgeDecision::kStep) continue;
    if (kind_of(loops[i], truth.positions, truth.points, tree) == LoopKind::kHole)
      surfaces.take_found(points_of(loops[i], truth), reach_of(loops[i], rule),
                          verdict == EdgeDecision::kRepeated);
  }
  return surfaces.areas();
}

}  // namespace

CloudScore score_cloud(const Result& result, const Truth& truth, const EvaluationRule& rule) {
  const Evaluation evaluation = evaluate(result, truth, rule);
  const LoopScores& scores = evaluation.scores;
  CloudScore score{.false_loops = scores.false_loops + scores.repeated,
                   .repeated = scores.repeated,
                   .joined_or_parted = scores.joined + scores.parted};
  for (const Tally& width : evaluation.holes) {
    score.holes.found += width.found;
    score.holes.all += width.all;
  }
  score.outer_curves = {.found = scores.found - score.holes.found,
                        .all = scores.true_loops - score.holes.all};

  std::vector<std::uint64_t> ids;
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    if (evaluation.loops.loops[i].verdict != EdgeDecision::kStep)
      ids.insert(ids.end(), result.loops[i].begin(), result.loops[i].end());
  }
  const MatchRule match = match_rule(truth, rule, evaluation.tolerances);
  if (result.boundary) ids = *result.boundary;
  const auto score_against = [&](std::span<const TrueLoop> loops) {
    return score_points(ids, loops, truth.positions, truth.stand_ins, match);
  };
  std::vector<TrueLoop> counting;
  for (std::size_t i = 0; i < truth.loops.size(); ++i) {
    if (evaluation.loops.true_loops[i].counts) counting.push_back(truth.loops[i]);
  }
  score.points = score_against(counting);
  const PointScores all = score_against(truth.loops).within_tolerance;
  score.points.within_tolerance = point_scores(all.precision, score.points.within_tolerance.recall);
  score.areas = compare_areas(result.loops, truth, evaluation.loops, match);
  for (double* area : {&score.areas.truth, &score.areas.covered, &score.areas.found, &score.areas.right})
    *area /= truth.spacing * truth.spacing;
  return score;
}

}  // namespace lacuna::evaluation
