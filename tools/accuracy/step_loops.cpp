#include "tools/accuracy/step_loops.hpp"

#include "tools/accuracy/edge_tree.hpp"

#include <algorithm>
#include <utility>

namespace lacuna::accuracy {
using namespace io;

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
  const EdgeTree step_edges = tree_of_steps(steps, positions), true_edges = tree_of_truth(truth, positions);
  std::vector<std::size_t> near;
  for (std::size_t loop = 0; loop < loops.size(); ++loop) {
    LoopMatch& match = accuracy.loops[loop];
    if (match.verdict != EdgeDecision::kFalse) continue;
    std::size_t on_step = 0, on_either = 0;
    for (const std::uint64_t id : loops[loop]) {
      step_edges.owners_within(positions[id], rule.tolerance, near);
      const bool at_step = !near.empty();
      true_edges.owners_within(positions[id], rule.tolerance, near);
      on_step += at_step;
      on_either += at_step || std::any_of(near.begin(), near.end(),
                                          [&](std::size_t hit) { return accuracy.true_loops[hit].counts; });
    }
    const auto points = static_cast<double>(loops[loop].size());
    match.on_step = static_cast<double>(on_step) / points;
    if (match.on_step >= rule.share) {
      match.verdict = EdgeDecision::kStep;
    } else if (static_cast<double>(on_either) / points >= rule.share) {
      match.verdict = EdgeDecision::kJoined;
    }
  }
  accuracy.scores = score_loops(accuracy.loops, accuracy.true_loops);
}

}  // namespace lacuna::accuracy
