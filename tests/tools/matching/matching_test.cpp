// SPDX-License-Identifier: Apache-2.0
// Which loops are of one hole: true and found ones, and loops of two results.
#include "bench/evaluation/evaluation.hpp"
#include "io/explain/matching/compare_loops.hpp"
#include "io/explain/matching/match_loops.hpp"
#include "tests/support/test.hpp"
#include "tests/tools/matching/drawn.hpp"
#include "tools/commands/compare_command.hpp"

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

// As Catch prints and compares them.
static bool operator==(const LoopChange& a, const LoopChange& b) {
  return a.change == b.change && a.before == b.before && a.after == b.after;
}

namespace {

ComparedLoop circle(double x, double radius, double phase = 0) {
  constexpr int kPoints = 60;
  ComparedLoop loop;
  loop.measures.area = std::numbers::pi * radius * radius;
  loop.measures.normal = {0, 0, 1};
  for (int i = 0; i < kPoints; ++i) {
    const double angle = phase + 2 * std::numbers::pi * i / kPoints;
    loop.points.emplace_back(x + radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return loop;
}

// The left or right half of a circle, along its diameter.
ComparedLoop half(double x, double radius, double side) {
  ComparedLoop loop;
  loop.measures.area = std::numbers::pi * radius * radius / 2;
  for (int i = -30; i <= 30; ++i) {
    const double angle = std::numbers::pi * i / 60;
    loop.points.emplace_back(x + side * radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  for (int i = 20; i >= -20; --i) loop.points.emplace_back(x + side * 0.15, radius * i / 21, 0);
  return loop;
}

// An even plane from -5 to 30, without the points that `is_empty` is true for.
template <class Empty>
std::vector<Eigen::Vector3d> plane(Empty&& is_empty) {
  constexpr double kSpacing = 0.2;
  std::vector<Eigen::Vector3d> points;
  for (double x = -5; x <= 30; x += kSpacing) {
    for (double y = -5; y <= 5; y += kSpacing)
      if (!is_empty(x, y)) points.emplace_back(x, y, 0);
  }
  return points;
}

std::vector<Eigen::Vector3d> whole_plane() {
  return plane([](double, double) { return false; });
}

using Changes = std::vector<LoopChange>;

Changes compared(const std::vector<ComparedLoop>& before, const std::vector<ComparedLoop>& after,
                 const std::vector<Eigen::Vector3d>& sample_before = whole_plane(),
                 const std::vector<Eigen::Vector3d>& sample_after = whole_plane()) {
  return compare_loops({before, sample_before, 0.2}, {after, sample_after, 0.2}, 0.2);
}

TEST_CASE("a result compared with itself has the same holes, whichever points the curves take") {
  const std::vector<ComparedLoop> loops = {circle(0, 1), circle(5, 2), circle(20, 1)};
  const Changes same = {{Change::kSame, {0}, {0}}, {Change::kSame, {1}, {1}}, {Change::kSame, {2}, {2}}};
  CHECK(compared(loops, loops) == same);
  CHECK(compared(loops, {circle(0, 1, 0.03), circle(5, 2, 0.1), circle(20.05, 1)}) == same);
  CHECK(compared({}, {}).empty());
}

TEST_CASE("a hole that one result has is closed or opened where the other scan has surface") {
  CHECK(compared({circle(0, 1), circle(5, 1)}, {circle(5, 1), circle(9, 1)}) ==
        Changes{{Change::kSame, {1}, {0}}, {Change::kOpened, {}, {1}}, {Change::kClosed, {0}, {}}});
}

TEST_CASE("a hole that both scans have, but one result alone found, is neither closed nor opened") {
  const auto punched = plane([](double x, double y) { return x * x + y * y < 1; });
  CHECK(compared({circle(0, 1)}, {}, punched, punched) == Changes{{Change::kNotFoundNow, {0}, {}}});
  CHECK(compared({}, {circle(0, 1)}, punched, punched) == Changes{{Change::kFoundNow, {}, {0}}});
}

TEST_CASE("a hole is not comparable where the other scan does not reach it, or its sample is too coarse") {
  CHECK(compared({circle(50, 1)}, {circle(5, 1)}) ==
        Changes{{Change::kOpened, {}, {0}}, {Change::kNotComparable, {0}, {}}});
  CHECK(compared({circle(0, 0.25)}, {}) == Changes{{Change::kNotComparable, {0}, {}}});
  CHECK(compared({circle(0, 1)}, {}, {}, {}) == Changes{{Change::kNotComparable, {0}, {}}});
}

TEST_CASE("an outer curve is closed where the other scan goes on beyond it") {
  ComparedLoop outer = circle(0, 1);
  outer.measures.kind = LoopKind::kOuter;
  const auto disc = plane([](double x, double y) { return x * x + y * y > 1; });
  CHECK(compared({outer}, {}, disc) == Changes{{Change::kClosed, {0}, {}}});
  CHECK(compared({outer}, {}, disc, disc) == Changes{{Change::kNotFoundNow, {0}, {}}});
}

TEST_CASE("a hole with another area has changed") {
  CHECK(compared({circle(0, 1)}, {circle(0, 1.15)}) == Changes{{Change::kChanged, {0}, {0}}});
}

TEST_CASE("another spacing of the points does not change a hole") {
  const auto sampled = [](double radius, double spacing) {
    ComparedLoop loop = circle(0, radius);
    loop.measures.perimeter = 2 * std::numbers::pi * radius;
    loop.measures.track.evidence.spacing = spacing;
    return loop;
  };
  CHECK(compared({sampled(1, 0.05)}, {sampled(1.15, 0.05)}) == Changes{{Change::kChanged, {0}, {0}}});
  CHECK(compared({sampled(1, 0.05)}, {sampled(1.15, 0.3)}) == Changes{{Change::kSame, {0}, {0}}});
  CHECK(compared({sampled(1.15, 0.3)}, {sampled(1, 0.05)}) == Changes{{Change::kSame, {0}, {0}}});
}

TEST_CASE("a hole that was divided has one line with its parts, and so have parts that were joined") {
  const std::vector<ComparedLoop> whole = {circle(0, 3)}, halves = {half(0, 3, -1), half(0, 3, 1)};
  CHECK(compared(whole, halves) == Changes{{Change::kChanged, {0}, {0, 1}}});
  CHECK(compared(halves, whole) == Changes{{Change::kChanged, {0, 1}, {0}}});
}

// A result with one hole, in a unit of so many lengths of the first one.
tools::ComparedResult result(double lengths, const std::string& unit, const std::string& crs = "") {
  ComparedLoop hole = circle(0, lengths);
  tools::ComparedResult result{.folder = unit + "_", .median_distance = 0.1 * lengths, .extent = 9 * lengths};
  for (const Eigen::Vector3d& point : plane([](double x, double y) { return std::hypot(x, y) < 1; }))
    result.scan.sample.push_back(lengths * point);
  result.scan.spacing = 0.2 * lengths;
  result.scan.loops = {hole};
  result.unit = unit;
  result.crs = crs;
  return result;
}

TEST_CASE("results in two units are compared in the second one") {
  const tools::Comparison comparison(result(1, "m"), result(1000, "mm"));
  CHECK(comparison.changes == Changes{{Change::kSame, {0}, {0}}});
  CHECK(comparison.warnings.empty());
  CHECK(comparison.before.scan.loops[0].measures.area == Approx(1e6 * std::numbers::pi));
  CHECK(comparison.before.unit == "mm");
}

TEST_CASE("units and systems that one side alone states are a warning, and two systems are refused") {
  const auto warning = [](const tools::ComparedResult& before, const tools::ComparedResult& after) {
    const tools::Comparison comparison(before, after);
    return comparison.warnings.empty() ? "" : comparison.warnings.at(0);
  };
  CHECK(warning(result(1, ""), result(1, "")).empty());
  CHECK_THAT(warning(result(1, "m"), result(1, "")), Contains("its unit is not known, and that of m_ is m"));
  for (const double lengths : {1000., 1 / 0.3048, 25.4})
    CHECK_THAT(warning(result(lengths, ""), result(1, "")), Contains("times as large as the other, as"));
  CHECK_THAT(warning(result(1, "m", "EPSG:25832"), result(1, "m")),
             Contains("its coordinate reference system is not known"));
  CHECK_THROWS_WITH(tools::Comparison(result(1, "m", "EPSG:25832"), result(1, "m", "EPSG:25833")),
                    Contains("only results of one system can be compared"));
}

TEST_CASE(
    "the scene of a comparison has the changes of its loops, and the loops that only the first result has") {
  tools::ComparedResult before = result(1, "m");
  before.scan.loops = {circle(40, 1), circle(0, 1)};
  const tools::Comparison comparison(before, result(1, "m"));
  io::Scene scene;
  scene.origin = {-5, -5, 0};
  scene.edge = 35;
  scene.points.positions = {{5, 5, 0}};
  scene.loops.ids = {0};
  scene.loops.all = 1;
  scene.loops.measures.resize(1);
  scene.loops.vertices = {{6, 5, 0}, {5, 6, 0}, {4, 5, 0}};
  scene.loops.first = {0, 3};
  comparison.show_in(scene);
  CHECK(scene.compared == "m_");
  CHECK(scene.loops.ids == std::vector<std::uint64_t>{0, 1});
  CHECK(scene.loops.changes == std::vector<std::string>{"same", "not_comparable"});
  CHECK(scene.loops.earlier == std::vector<std::string>{"1", "0"});
  CHECK(scene.loops.first == std::vector<std::size_t>{0, 3, 63});
  // All is where it was, and within the cube, which has grown.
  const auto place = [&](const Eigen::Vector3f& at) {
    return Eigen::Vector3d(scene.origin + at.cast<double>());
  };
  CHECK((place(scene.points.positions[0]) - Eigen::Vector3d(0, 0, 0)).norm() < 1e-5);
  CHECK((place(scene.loops.vertices[0]) - Eigen::Vector3d(1, 0, 0)).norm() < 1e-5);
  CHECK((place(scene.loops.vertices[3]) - Eigen::Vector3d(41, 0, 0)).norm() < 1e-5);
  for (const Eigen::Vector3f& vertex : scene.loops.vertices) {
    CHECK(vertex.minCoeff() >= 0);
    CHECK(vertex.maxCoeff() <= scene.edge);
  }
}

}  // namespace

}  // namespace lacuna::matching
