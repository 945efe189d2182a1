// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/step_loops.hpp"

#include "bench/evaluation/loop_scores.hpp"
#include "tools/matching/edge_tree.hpp"

#include <utility>
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
  const EdgeTree edges = tree_of_steps(steps, positions);
  std::vector<std::size_t> near;
  const auto at = [&](std::size_t loop, std::size_t point) {
    const std::uint64_t id = loops[loop][point];
    edges.owners_within(positions[id], rule.tolerance_at(id), near);
    return !near.empty();
  };
  decide_false_loops(loops, truth, positions, rule, EdgeDecision::kStep, &LoopMatch::on_step, at, accuracy);
}

}  // namespace lacuna::evaluation
