// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/cloud_score.hpp"

#include <span>

namespace lacuna::evaluation {

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
