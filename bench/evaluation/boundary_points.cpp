// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/boundary_points.hpp"

#include "io/explain/matching/nearest.hpp"

#include <algorithm>
#include <iterator>

namespace lacuna::evaluation {
namespace {

using Ids = std::vector<std::uint64_t>;
using Positions = std::span<const Eigen::Vector3d>;

std::size_t count_common(const Ids& a, const Ids& b) {
  Ids common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common.size();
}

EdgeTree tree_of_points(const Ids& ids, Positions positions) {
  std::vector<Segment> points;
  for (const std::uint64_t id : ids) points.push_back({positions[id], positions[id], 0});
  return EdgeTree(std::move(points));
}

// Returns how many of `ids` are within their tolerance of the segments in the tree.
std::size_t count_near(const Ids& ids, const EdgeTree& tree, Positions positions, const MatchRule& rule) {
  std::size_t near = 0;
  std::vector<std::size_t> found;
  for (const std::uint64_t id : ids) {
    tree.owners_within(positions[id], rule.tolerance_at(id), found);
    near += found.empty() ? 0 : 1;
  }
  return near;
}

std::optional<double> share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

PointScores point_scores(std::optional<double> precision, std::optional<double> recall) {
  PointScores scores{.precision = precision, .recall = recall, .f1 = std::nullopt};
  if (!precision && !recall) return scores;
  const double p = precision.value_or(0), r = recall.value_or(0);
  scores.f1 = p + r > 0 ? 2 * p * r / (p + r) : 0;
  return scores;
}

PointAccuracy score_points(std::span<const std::uint64_t> flagged, std::span<const TrueLoop> truth,
                           Positions positions, std::span<const std::uint64_t> stand_ins,
                           const MatchRule& rule) {
  Ids told, known;
  for (const std::uint64_t id : flagged) told.push_back(stand_ins[id]);
  for (const TrueLoop& loop : truth) known.insert(known.end(), loop.vertices.begin(), loop.vertices.end());
  sort_once(told);
  sort_once(known);
  const std::size_t common = count_common(told, known);
  const std::size_t right = count_near(told, tree_of_truth(truth, positions), positions, rule);
  const std::size_t met = count_near(known, tree_of_points(told, positions), positions, rule);
  return {.flagged = told.size(),
          .truth = known.size(),
          .by_id = point_scores(share(common, told.size()), share(common, known.size())),
          .within_tolerance = point_scores(share(right, told.size()), share(met, known.size()))};
}

}  // namespace lacuna::evaluation
