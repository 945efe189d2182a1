// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/step_loops.hpp"

#include "tests/tools/matching/drawn.hpp"

#include <catch2/catch.hpp>

namespace lacuna::evaluation {
using namespace io;

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

TEST_CASE("a false loop along a step of density is a step, neither found nor false") {
  Drawing drawing;
  const LoopIds ring = drawing.ring(40, 0, 0);
  const LoopIds near = drawing.ring(38, 0.2, 0);
  const LoopIds hole = drawing.ring(30, 100, 0);
  const LoopIds far = drawing.ring(30, 200, 0);
  LoopIds step = ring;
  step.push_back(ring[0]);
  const LoopAccuracy result = match(drawing, {near, hole, far}, {hole}, {step});
  CHECK(result.loops[0].verdict == EdgeDecision::kStep);
  CHECK(result.loops[0].on_step == 1);
  CHECK(result.loops[1].verdict == EdgeDecision::kFound);
  CHECK_FALSE(result.loops[1].on_step);
  CHECK(result.loops[2].verdict == EdgeDecision::kFalse);
  CHECK(result.loops[2].on_step == 0);
  CHECK((result.scores.steps == 1 && result.scores.false_loops == 1 && result.scores.found == 1));
  CHECK(result.scores.precision == 0.5);
}

TEST_CASE("a step is no true loop: nothing is missed where it is not found") {
  Drawing drawing;
  const LoopIds step = drawing.ring(40, 0, 0);
  const LoopAccuracy result = match(drawing, {}, {}, {step});
  CHECK((result.scores.true_loops == 0 && result.scores.missed == 0));
  CHECK_FALSE(result.scores.precision);
}

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
