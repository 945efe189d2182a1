// SPDX-License-Identifier: Apache-2.0
#include "io/explain/matching/match_loops.hpp"

#include "bench/evaluation/evaluation.hpp"
#include "tests/tools/matching/drawn.hpp"

namespace lacuna::matching {
using evaluation::LoopScores;
using enum EdgeDecision;

namespace {

using Verdicts = std::vector<EdgeDecision>;

LoopAccuracy match(const Drawing& drawing, const std::vector<LoopIds>& loops,
                   const std::vector<LoopIds>& truth, const MatchRule& rule = {.tolerance = 2}) {
  return match_loops(loops, loops_through(truth, stand_ins(drawing.positions)), drawing.positions, rule);
}

Verdicts verdicts(const LoopAccuracy& result) {
  Verdicts verdicts;
  for (const auto& loop : result.loops) verdicts.push_back(loop.verdict);
  return verdicts;
}

LoopScores scores_of(const LoopAccuracy& result) {
  return evaluation::score_loops(result.loops, result.true_loops);
}

// There and back again, so that no edge cuts across.
LoopIds and_back(LoopIds ids) {
  for (std::size_t i = ids.size() - 1; i-- > 1;) ids.push_back(ids[i]);
  return ids;
}

}  // namespace

TEST_CASE("a loop along a true loop finds it, the next ones repeat it") {
  Drawing drawing;
  const LoopIds ring = drawing.ring(40, 0, 0);
  const LoopIds beside = drawing.ring(36, 0.3, 0);
  const LoopIds far = drawing.ring(40, 100, 0);
  const LoopAccuracy result = match(drawing, {beside, ring, ring}, {far, ring});
  CHECK(verdicts(result) == Verdicts{kFound, kRepeated, kRepeated});
  CHECK(result.loops[0].true_loop == 1u);
  CHECK(result.loops[0].on == 1);
  CHECK(result.loops[0].covered == 1);
  CHECK_FALSE(result.true_loops[0].found_by);
  CHECK(result.true_loops[1].found_by == 0u);
  const LoopScores scores = scores_of(result);
  CHECK((scores.true_loops == 2 && scores.found == 1 && scores.missed == 1));
  CHECK((scores.loops == 3 && scores.false_loops == 0 && scores.repeated == 2));
  CHECK(scores.recall == 0.5);
  CHECK(scores.precision == 1);
}

TEST_CASE("a loop along a narrow true loop is neither right nor wrong") {
  Drawing drawing;
  const LoopIds ring = drawing.ring(40, 0, 0), far = drawing.ring(40, 100, 0);
  std::vector<TrueLoop> truth = loops_through(std::vector{ring, far}, stand_ins(drawing.positions));
  truth[0].is_narrow = true;
  const LoopAccuracy result = match_loops(std::vector{ring, far}, truth, drawing.positions, {.tolerance = 2});
  CHECK(verdicts(result) == Verdicts{kShort, kFound});
  const LoopScores scores = scores_of(result);
  CHECK((scores.true_loops == 1 && scores.found == 1 && scores.false_loops == 0));
}

TEST_CASE("a loop that covers less than 70 percent of a true one does not find it") {
  Drawing drawing;
  const LoopIds ring = drawing.ring(100, 0, 0);
  // The vertices within the tolerance beyond both ends are covered, too.
  const LoopAccuracy less = match(drawing, {and_back(part(ring, 0.60))}, {ring}, {.tolerance = 1.5});
  CHECK(less.loops[0].verdict == kParted);
  CHECK(less.loops[0].true_loop == 0u);
  CHECK(less.loops[0].on == 1);
  CHECK(less.loops[0].covered == Approx(0.62));
  CHECK(scores_of(less).found == 0);
  CHECK(scores_of(less).precision == 0);
  const LoopAccuracy more = match(drawing, {and_back(part(ring, 0.68))}, {ring}, {.tolerance = 1.5});
  CHECK(more.loops[0].covered == Approx(0.70));
  CHECK(more.loops[0].verdict == kFound);
}

TEST_CASE("a loop of which less than 70 percent lies on a true one is false") {
  Drawing drawing;
  const LoopIds ring = drawing.ring(40, 0, 0);
  LoopIds away = ring;
  for (int i = 0; i < 18; ++i) away.push_back(drawing.point(30 + i, 0));
  CHECK(match(drawing, {away}, {ring}).loops[0].verdict == kFalse);
  CHECK(match(drawing, {away}, {ring}).loops[0].on == Approx(40.0 / 58));
  away.pop_back();
  CHECK(match(drawing, {away}, {ring}).loops[0].verdict == kFound);
}

// A square of `side` edges of length 1 to a side, with a corner at (x, y), counterclockwise.
LoopIds square(Drawing& drawing, int side, int x, int y) {
  LoopIds ids;
  for (const auto& [px, py] : places_around(x, y, side, side)) ids.push_back(drawing.point(px, py));
  return ids;
}

LoopIds chain(LoopIds ids, const LoopIds& more) {
  ids.insert(ids.end(), more.begin(), more.end());
  return ids;
}

TEST_CASE("a loop that covers a true one and most of which lies on another is joined") {
  Drawing drawing;
  const LoopIds small = square(drawing, 3, 0, 0);
  const LoopIds large = square(drawing, 30, 20, 0);
  const LoopIds loop = chain(small, part(large, 0.5));
  const LoopAccuracy result = match(drawing, {loop}, {large, small}, {.tolerance = 0.5});
  CHECK(result.loops[0].verdict == kJoined);
  CHECK(result.loops[0].true_loop == 1u);
  CHECK(result.loops[0].on == Approx(12.0 / 72));
  // On the large one lie 60 of 72 points.
  CHECK(match(drawing, {loop}, {large}, {.tolerance = 0.5}).loops[0].verdict == kParted);
}

TEST_CASE("a loop along parts of two true loops is joined, though it covers neither") {
  Drawing drawing;
  const LoopIds left = square(drawing, 10, 0, 0);
  const LoopIds right = square(drawing, 10, 30, 0);
  const LoopIds loop = chain(part(left, 0.5), part(right, 0.5));
  CHECK(match(drawing, {loop}, {left, right}, {.tolerance = 0.5}).loops[0].verdict == kJoined);
  // Without the second one, half of it lies on nothing.
  CHECK(match(drawing, {loop}, {left}, {.tolerance = 0.5}).loops[0].verdict == kFalse);
}

TEST_CASE("the halves of a true loop are parted, unless one of them covers 70 percent of it") {
  Drawing drawing;
  const LoopIds ring = square(drawing, 20, 0, 0);
  const LoopIds below(ring.begin(), ring.begin() + 31), above(ring.begin() + 30, ring.end());
  const LoopAccuracy result = match(drawing, {below, above}, {ring}, {.tolerance = 1});
  CHECK(verdicts(result) == Verdicts{kParted, kParted});
  CHECK(
      (scores_of(result).parted == 2 && scores_of(result).false_loops == 0 && scores_of(result).missed == 1));
  CHECK(scores_of(result).precision == 0);
  const LoopIds most(ring.begin(), ring.begin() + 60), rest(ring.begin() + 60, ring.end());
  const LoopAccuracy uneven = match(drawing, {most, rest}, {ring}, {.tolerance = 1});
  CHECK(verdicts(uneven) == Verdicts{kFound, kParted});
}

TEST_CASE("short true loops count neither as found nor as missed, and loops on them are not false") {
  Drawing drawing;
  const LoopIds small = drawing.ring(7, 0, 0);
  const LoopIds missed = drawing.ring(7, 50, 0);
  const LoopIds large = drawing.ring(8, 100, 0);
  const LoopAccuracy result = match(drawing, {small, small}, {small, missed, large});
  CHECK(verdicts(result) == Verdicts{kShort, kShort});
  CHECK_FALSE(result.true_loops[0].counts);
  CHECK(result.true_loops[0].found_by == 0u);
  const LoopScores scores = scores_of(result);
  CHECK((scores.true_loops == 1 && scores.short_loops == 2 && scores.found == 0 && scores.missed == 1));
  CHECK((scores.false_loops == 0 && scores.repeated == 0 && scores.precision == 1));
  CHECK(scores_of(match(drawing, {small}, {small}, {.tolerance = 2, .min_vertices = 7})).found == 1);
}

TEST_CASE("a loop on a short true loop next to a long one goes to the long one") {
  Drawing drawing;
  const LoopIds ring = drawing.ring(20, 0, 0);
  const LoopIds sparse = {ring[0], ring[4], ring[8], ring[12], ring[16]};
  const LoopAccuracy result = match(drawing, {ring}, {sparse, ring});
  CHECK(result.loops[0].verdict == kFound);
  CHECK(result.loops[0].true_loop == 1u);
}

TEST_CASE("distances are to edges, so long ones hide nothing") {
  Drawing drawing;
  LoopIds corners;
  for (const auto& [x, y] : {std::pair{0, 0}, {30, 0}, {30, 30}, {0, 30}})
    corners.push_back(drawing.point(x, y));
  const LoopIds dense = square(drawing, 30, 0, 0);
  const MatchRule rule{.tolerance = 0.5, .min_vertices = 4};
  CHECK(scores_of(match(drawing, {dense}, {corners}, rule)).found == 1);
  CHECK(scores_of(match(drawing, {corners}, {dense}, rule)).found == 1);
}

TEST_CASE("without loops and without truth there is no precision and no recall") {
  const LoopAccuracy nothing = match(Drawing{}, {}, {});
  CHECK_FALSE(scores_of(nothing).precision);
  CHECK_FALSE(scores_of(nothing).recall);
  Drawing drawing;
  const LoopIds ring = drawing.ring(40, 0, 0);
  CHECK(scores_of(match(drawing, {}, {ring})).recall == 0);
  CHECK(scores_of(match(drawing, {ring}, {})).precision == 0);
  CHECK(scores_of(match(drawing, {ring}, {})).false_loops == 1);
}

TEST_CASE("points that are not finite are near nothing") {
  Drawing drawing;
  LoopIds ring = drawing.ring(40, 0, 0);
  drawing.positions[ring[3]].x() = std::numeric_limits<double>::quiet_NaN();
  const LoopAccuracy result = match(drawing, {ring}, {ring});
  CHECK(result.loops[0].on == Approx(39.0 / 40));
  CHECK(scores_of(result).found == 1);
}

}  // namespace lacuna::matching
