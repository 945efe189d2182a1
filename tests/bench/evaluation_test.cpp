// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/evaluation.hpp"

#include "io/explain/matching/match_loops.hpp"
#include "io/explain/matching/nearest.hpp"
#include "tests/io/io_support.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"
#include "tests/tools/matching/drawn.hpp"

namespace lacuna::evaluation {

namespace {

using Ids = std::vector<std::uint64_t>;

}  // namespace

TEST_CASE("the lowest id stands for all points of a place, and one that is not finite for itself") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Eigen::Vector3d> positions = {{1, 0, 0},   {nan, 0, 0},  {0, -0.0, 0}, {1, 0, 0},
                                                  {nan, 0, 0}, {-0.0, 0, 0}, {1, -0.0, 0}};
  CHECK(stand_ins(positions) == Ids{0, 1, 2, 0, 4, 2, 0});
}

TEST_CASE("the spacing is the median of the mean distance to four neighbours") {
  const auto spacing_of = [](const std::vector<Eigen::Vector3d>& points) {
    return median_spacing(points, PointTree(points));
  };
  CHECK(spacing_of(plane(20).positions) == Approx(1));
  CHECK(spacing_of(plane(20).scaled(0.5).translated({1e6, 0, 0}).positions) == Approx(0.5));
  CHECK(spacing_of(line(101).positions) == Approx(1.5));  // 1, 1, 2, 2
  CHECK(spacing_of(line(3).positions) == Approx(1.5));    // the ends: 1, 2
  CHECK(spacing_of(line(1).positions) == 0);
  CHECK(spacing_of({}) == 0);
}

TEST_CASE("the tree of edges finds what a look at each finds") {
  Random random(1);
  for (const std::size_t count : {0u, 1u, 8u, 9u, 500u}) {
    std::vector<Segment> segments;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d a = 10 * random.direction();
      const double length = random.chance(0.1) ? 20 : random.uniform();
      segments.push_back(
          {a, random.chance(0.2) ? a : Eigen::Vector3d(a + length * random.direction()), i / 3});
    }
    const EdgeTree tree(segments);
    std::vector<std::size_t> found, expected;
    for (int look = 0; look < 200; ++look) {
      const Eigen::Vector3d point = 10 * random.direction();
      const double radius = random.uniform(0, 3);
      expected.clear();
      for (const Segment& segment : segments) {
        if (distance_to(segment, point) > radius) continue;
        if (expected.empty() || expected.back() != segment.owner) expected.push_back(segment.owner);
      }
      tree.owners_within(point, radius, found);
      CHECK(found == expected);
    }
  }
}

TEST_CASE("flagged points are right at a true vertex, or within the tolerance of a true edge") {
  Drawing drawing;
  const LoopIds ring = drawing.ring(10, 0, 0);
  const std::uint64_t same = drawing.point(drawing.positions[0].x(), drawing.positions[0].y());
  const std::uint64_t near = drawing.point(drawing.positions[5].x() - 0.4, drawing.positions[5].y());
  const Eigen::Vector3d middle = (drawing.positions[2] + drawing.positions[3]) / 2;
  const Eigen::Vector3d beside_edge = middle + 0.3 * middle.normalized();  // 0.58 from both ends
  const std::uint64_t between = drawing.point(beside_edge.x(), beside_edge.y());
  const std::uint64_t far = drawing.point(50, 0);
  const auto stands_for = stand_ins(drawing.positions);
  const std::vector<LoopIds> rings = {ring};
  const auto truth = loops_through(rings, stands_for);
  const auto score = [&](const Ids& flagged) {
    return score_points(flagged, truth, drawing.positions, stands_for, {.tolerance = 0.5});
  };

  const PointAccuracy result = score({same, ring[0], ring[1], near, between, far});
  CHECK(result.flagged == 5);
  CHECK(result.truth == 10);
  CHECK(result.by_id.precision == 0.4);
  CHECK(result.by_id.recall == 0.2);
  CHECK(*result.by_id.f1 == Approx(4 / 15.));
  CHECK(result.within_tolerance.precision == 0.8);
  CHECK(result.within_tolerance.recall == Approx(0.3));

  CHECK(score(ring).by_id.f1 == 1);
  CHECK(score({far}).by_id.f1 == 0);
  CHECK_FALSE(score({}).by_id.precision);
  CHECK(score({}).by_id.recall == 0);
  CHECK(score({}).by_id.f1 == 0);
  const PointAccuracy none = score_points({}, {}, drawing.positions, stands_for, {});
  CHECK_FALSE(none.by_id.f1);
}

TEST_CASE("the area under the ROC curve is the share of pairs in the right order") {
  const auto area = [](std::vector<EdgeDecision> verdicts, std::vector<double> confidence) {
    std::vector<LoopMatch> loops;
    for (const EdgeDecision verdict : verdicts) loops.push_back({.verdict = verdict});
    return area_under_roc(loops, confidence);
  };
  using enum EdgeDecision;
  CHECK(area({kFound, kRepeated, kFalse, kFalse}, {0.9, 0.8, 0.2, 0.1}) == 1);
  CHECK(area({kFound, kFound, kFalse, kFalse}, {0.9, 0.15, 0.2, 0.1}) == 0.75);
  CHECK(area({kFound, kFalse}, {0.5, 0.5}) == 0.5);
  CHECK(area({kFound, kFalse}, {0.1, 0.2}) == 0);
  CHECK(area({kFound, kFalse, kShort, kFalse}, {0.5, 0.4, 0.1, std::nan("")}) == 1);
  CHECK(area({kFound, kJoined, kParted, kFalse}, {0.5, 0.9, 0.1, 0.4}) == 1);
  CHECK_FALSE(area({kFound, kFound}, {0.5, 0.4}));
  CHECK_FALSE(area({kFalse}, {0.5}));
  CHECK_FALSE(area({}, {}));
}

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

namespace {

// The points of a grid, a unit apart, around a square.
LoopIds around(const std::vector<Eigen::Vector3d>& grid, int low, int edge) {
  LoopIds ids;
  for (const auto& [x, y] : places_around(low, low, edge, edge))
    ids.push_back(std::uint64_t(std::ranges::find(grid, Eigen::Vector3d(x, y, 0)) - grid.begin()));
  return ids;
}

}  // namespace

TEST_CASE("the width of a square hole is half its edge over the local spacing, an outer curve has none") {
  // A vertex has neighbours at 1, 1, 1 and sqrt(2); at a corner all four are at 1.
  std::vector<Eigen::Vector3d> grid = plane(20).positions;
  std::erase_if(grid, [](const Eigen::Vector3d& p) {
    return p.head<2>().minCoeff() > 4 && p.head<2>().maxCoeff() < 10;
  });
  const PointTree tree(grid);
  const std::vector<LoopIds> loops = {around(grid, 4, 6), around(grid, 0, 19)};
  std::vector<std::uint64_t> own(grid.size());
  std::iota(own.begin(), own.end(), std::uint64_t{0});
  const std::vector<TrueLoop> truth = loops_through(loops, own);
  const double spacing = (20 * (3 + std::sqrt(2)) / 4 + 4) / 24;
  CHECK(*hole_width(truth[0], grid, grid, tree) == Approx(3 / spacing));
  CHECK_FALSE(hole_width(truth[1], grid, grid, tree));
}

TEST_CASE("a hole counts in the class that begins at its width, found or not") {
  const TrueMatch found{.found_by = 0}, missed, uncounted{.counts = false};
  const std::vector<std::optional<double>> widths = {1.9, 2.0, 2.9, 10.0, 80.0, std::nullopt, 4.0};
  const std::vector<TrueMatch> matches = {missed, found, missed, found, found, found, uncounted};
  const HolesByWidth holes = holes_by_width(widths, matches);
  const std::array<std::array<std::size_t, 2>, 5> expected = {{{0, 1}, {1, 2}, {0, 0}, {0, 0}, {2, 2}}};
  for (std::size_t i = 0; i < holes.size(); ++i)
    CHECK(std::array{holes[i].found, holes[i].all} == expected[i]);
}

TEST_CASE("a polyline near a true loop finds it, and one elsewhere is false, though no vertex is a point") {
  const ScratchFolder folder;
  // A sheet of 30 x 30 points, a unit apart. The true loop is the square from (10, 10) to (14, 14).
  std::string rows;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) rows += std::to_string(x) + " " + std::to_string(y) + " 0\n";
  const auto scan = folder.write("scan.xyz", rows);
  std::string truth_row, vertices, edges;
  const auto square = places_around(0, 0, 4, 4);
  for (const auto& [x, y] : square) truth_row += std::to_string((10 + y) * 30 + 10 + x) + " ";
  for (int loop = 0; loop < 2; ++loop) {
    for (int i = 0; i < 16; ++i) {
      vertices += std::to_string(10.3 + square[i][0] + 12 * loop) + " " +
                  std::to_string(10.3 + square[i][1]) + " 0.2\n";
      edges += std::to_string(16 * loop + i) + " " + std::to_string(16 * loop + (i + 1) % 16) + "\n";
    }
  }
  const auto truth_file = folder.write("true.txt", truth_row + "\n");
  Result result = read_result(folder.write(
      "found.ply",
      test::ply_header(test::vertices(32) + "element edge 32\nproperty int vertex1\nproperty int vertex2\n") +
          vertices + edges));
  const Truth truth = read_truth(truth_file, {io::ScanInput(scan)}, result);
  CHECK(truth.positions.size() == 900 + 32);
  CHECK(truth.spacing == Approx(1));
  const Evaluation evaluation = evaluate(result, truth, {});
  REQUIRE(evaluation.loops.loops.size() == 2);
  CHECK(evaluation.loops.loops[0].verdict == EdgeDecision::kFound);
  CHECK(evaluation.loops.loops[1].verdict == EdgeDecision::kFalse);
}

TEST_CASE("a list of loops has to follow its curves, and a run's loops, which do, may have long edges") {
  const ScratchFolder folder;
  std::string rows,
      ids;  // 40 pairs of near points, 100 apart: the loop goes through the first of each, then the others
  for (int pair = 0; pair < 40; ++pair)
    for (int point = 0; point < 2; ++point) rows += std::to_string(100 * pair + point) + " 0 0\n";
  for (int point = 0; point < 2; ++point)
    for (int pair = 0; pair < 40; ++pair) ids += std::to_string(2 * pair + point) + " ";
  const auto scan = folder.write("scan.xyz", rows);
  Result result = read_result(folder.write("found.txt", ids + "\n"));
  const Truth truth = read_truth(folder.write("true.txt", ids + "\n"), {io::ScanInput(scan)}, result);
  Truth dense = truth;
  dense.spacing = 1;
  CHECK_THROWS_WITH(evaluate(result, dense, {}),
                    Catch::Contains("its points are not in order along a curve"));
  result.points = dense.positions.size();
  CHECK_NOTHROW(evaluate(result, dense, {}));
}

}  // namespace lacuna::evaluation
