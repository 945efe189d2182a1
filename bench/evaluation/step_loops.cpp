// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/step_loops.hpp"

#include "io/explain/matching/nearest.hpp"

#include <vector>

namespace lacuna::evaluation {
namespace {

EdgeTree tree_of_steps(std::span<const LoopIds> steps, std::span<const Eigen::Vector3d> positions) {
  std::vector<Segment> edges;
  for (std::size_t step = 0; step < steps.size(); ++step)
    for (std::size_t i = 1; i < steps[step].size(); ++i)
      edges.push_back({positions[steps[step][i - 1]], positions[steps[step][i]], step});
  return EdgeTree(std::move(edges));
}

}  // namespace

void mark_steps(std::span<const LoopIds> loops, std::span<const LoopIds> steps,
                std::span<const TrueLoop> truth, std::span<const Eigen::Vector3d> positions,
                const MatchRule& rule, LoopAccuracy& accuracy) {
  if (steps.empty()) return;
  std::vector<TrueLoop> counting;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (accuracy.true_loops[i].counts) counting.push_back(truth[i]);
  }
  const EdgeTree step_edges = tree_of_steps(steps, positions),
                 true_edges = tree_of_truth(counting, positions);
  std::vector<std::size_t> near;
  const auto is_near = [&](const EdgeTree& edges, std::uint64_t id) {
    edges.owners_within(positions[id], rule.tolerance_at(id), near);
    return !near.empty();
  };
  for (std::size_t loop = 0; loop < loops.size(); ++loop) {
    LoopMatch& match = accuracy.loops[loop];
    if (match.verdict != EdgeDecision::kFalse) continue;
    std::size_t on_step = 0, on_either = 0;
    for (const std::uint64_t id : loops[loop]) {
      const bool is_on_step = is_near(step_edges, id);
      on_step += is_on_step;
      on_either += is_on_step || is_near(true_edges, id);
    }
    const auto points = static_cast<double>(loops[loop].size());
    match.on_step = static_cast<double>(on_step) / points;
    if (match.on_step >= rule.share) {
      match.verdict = EdgeDecision::kStep;
    } else if (static_cast<double>(on_either) / points >= rule.share) {
      match.verdict = EdgeDecision::kJoined;
    }
  }
}

}  // namespace lacuna::evaluation
