// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/boundary_points.hpp"
#include "bench/evaluation/spacing.hpp"
#include "io/explain/matching/match_loops.hpp"
#include "io/explain/matching/nearest.hpp"
#include "tests/support/clouds.hpp"
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

}  // namespace lacuna::evaluation
