// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/step_loops.hpp"

#include "tests/tools/matching/drawn.hpp"

namespace lacuna::evaluation {
namespace {

LoopAccuracy match(const Drawing& drawing, const std::vector<LoopIds>& loops,
                   const std::vector<LoopIds>& truth, const std::vector<LoopIds>& steps) {
  const MatchRule rule{.tolerance = 2};
  const std::vector<TrueLoop> true_loops = loops_through(truth, stand_ins(drawing.positions));
  LoopAccuracy accuracy = match_loops(loops, true_loops, drawing.positions, rule);
  mark_steps(loops, steps, true_loops, drawing.positions, rule, accuracy);
  return accuracy;
}

// The first points of a loop, then as many of another.
LoopIds joined(const LoopIds& a, const LoopIds& b, double share) {
  LoopIds both = part(a, share);
  const LoopIds rest = part(b, 1 - share);
  both.insert(both.end(), rest.begin(), rest.end());
  return both;
}

}  // namespace

TEST_CASE("a loop along a true loop and a step is joined, one along less than 70 percent of both is false") {
  Drawing drawing;
  const LoopIds hole = drawing.ring(60, 0, 0);
  const LoopIds ring = drawing.ring(60, 60, 0);
  const LoopIds far = drawing.ring(60, 0, 300);
  CHECK(match(drawing, {joined(hole, ring, 0.5)}, {hole}, {ring}).loops[0].verdict == EdgeDecision::kJoined);
  CHECK(match(drawing, {joined(ring, far, 0.6)}, {hole}, {ring}).loops[0].verdict == EdgeDecision::kFalse);
  CHECK(match(drawing, {joined(ring, far, 0.8)}, {hole}, {ring}).loops[0].verdict == EdgeDecision::kStep);
}

TEST_CASE("a step is open unless its last id is its first") {
  Drawing drawing;
  LoopIds corner, chord;
  for (int i = 0; i <= 20; ++i) corner.push_back(drawing.point(i, 0));
  for (int i = 1; i <= 20; ++i) corner.push_back(drawing.point(20, i));
  for (int i = 4; i <= 16; ++i) chord.push_back(drawing.point(i, i));  // along the edge that would close it
  CHECK(match(drawing, {chord}, {}, {corner}).loops[0].verdict == EdgeDecision::kFalse);
  corner.push_back(corner.front());
  CHECK(match(drawing, {chord}, {}, {corner}).loops[0].verdict == EdgeDecision::kStep);
}

}  // namespace lacuna::evaluation
