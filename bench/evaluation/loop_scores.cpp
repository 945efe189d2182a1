// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loop_scores.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace lacuna::evaluation {

LoopScores score_loops(std::span<const LoopMatch> loops, std::span<const TrueMatch> truth) {
  LoopScores scores;
  for (const TrueMatch& loop : truth) {
    ++(loop.counts ? scores.true_loops : scores.short_loops);
    if (loop.counts) ++(loop.found_by ? scores.found : scores.missed);
  }
  scores.loops = loops.size();
  for (const LoopMatch& loop : loops) {
    scores.false_loops += loop.verdict == EdgeDecision::kFalse;
    scores.repeated += loop.verdict == EdgeDecision::kRepeated;
    scores.joined += loop.verdict == EdgeDecision::kJoined;
    scores.parted += loop.verdict == EdgeDecision::kParted;
    scores.steps += loop.verdict == EdgeDecision::kStep;
  }
  const auto share = [](std::size_t part, std::size_t whole) -> std::optional<double> {
    if (whole == 0) return std::nullopt;
    return static_cast<double>(part) / static_cast<double>(whole);
  };
  scores.recall = share(scores.found, scores.true_loops);
  const std::size_t judged = scores.loops - scores.steps;
  scores.precision = share(judged - scores.false_loops - scores.joined - scores.parted, judged);
  return scores;
}

std::optional<double> area_under_roc(std::span<const LoopMatch> loops, std::span<const double> confidence) {
  assert(confidence.size() == loops.size());
  struct Judged {
    double confidence;
    bool is_true;
  };
  std::vector<Judged> judged;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const EdgeDecision verdict = loops[i].verdict;
    const bool is_true = verdict == EdgeDecision::kFound || verdict == EdgeDecision::kRepeated;
    if (std::isnan(confidence[i]) || (!is_true && verdict != EdgeDecision::kFalse)) continue;
    judged.push_back({confidence[i], is_true});
  }
  std::sort(judged.begin(), judged.end(),
            [](const Judged& a, const Judged& b) { return a.confidence < b.confidence; });
  double wins = 0, false_below = 0, true_loops = 0;
  for (std::size_t i = 0, end = 0; i < judged.size(); i = end) {
    double tied_true = 0, tied_false = 0;
    for (; end < judged.size() && judged[end].confidence == judged[i].confidence; ++end) {
      ++(judged[end].is_true ? tied_true : tied_false);
    }
    wins += tied_true * (false_below + tied_false / 2);
    false_below += tied_false;
    true_loops += tied_true;
  }
  if (true_loops == 0 || false_below == 0) return std::nullopt;
  return wins / (true_loops * false_below);
}

}  // namespace lacuna::evaluation
