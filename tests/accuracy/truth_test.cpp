#include "tests/accuracy/drawn.hpp"
#include "tests/support/clouds.hpp"
#include "tools/accuracy/boundary_points.hpp"
#include "tools/accuracy/edge_tree.hpp"
#include "tools/accuracy/spacing.hpp"
#include "tools/accuracy/true_loops.hpp"

#include <algorithm>
#include <limits>

#include <catch2/catch.hpp>

namespace lacuna::accuracy {
namespace {

using Ids = std::vector<std::uint64_t>;

// A disc of n triangles around its centre; every triangle brings points of its own where `torn`, so that the
// disc hangs together by coordinates only. Returns the ids of its rim.
Ids add_disc(Drawing& drawing, std::vector<Triangle>& triangles, std::uint64_t n, double x, bool torn) {
  const LoopIds rim = drawing.ring(n, x, 0);
  const std::uint64_t centre = drawing.point(x, -0.0);
  for (std::uint64_t i = 0; i < n; ++i) {
    Triangle triangle = {centre, rim[i], rim[(i + 1) % n]};
    if (torn) {
      for (std::uint64_t& corner : triangle) {
        const Eigen::Vector3d p = drawing.positions[corner];
        corner = drawing.point(p.x(), p.y() + 0.0, p.z());
      }
    }
    triangles.push_back(triangle);
  }
  return rim;
}

}  // namespace

TEST_CASE("the boundary of two discs is two loops, also where their triangles share no vertex") {
  for (const bool torn : {false, true}) {
    Drawing drawing;
    std::vector<Triangle> triangles;
    const Ids first = add_disc(drawing, triangles, 12, 0, torn);
    const Ids second = add_disc(drawing, triangles, 20, 50, torn);
    const auto loops = mesh_boundary(triangles, stand_ins(drawing.positions));
    REQUIRE(loops.size() == 2);
    CHECK(loops[0].vertices == first);
    CHECK(loops[0].edges.size() == 12);
    CHECK(loops[1].vertices == second);
    CHECK(loops[1].edges.size() == 20);
  }
}

TEST_CASE("a hole is a loop beside the rim, joined to it where they touch") {
  // 5 x 5 squares without the one in the middle; a second hole takes the corner that they would share.
  const auto sheet = [](const std::vector<std::array<std::uint64_t, 2>>& missing) {
    std::vector<Triangle> triangles;
    for (std::uint64_t y = 0; y < 5; ++y) {
      for (std::uint64_t x = 0; x < 5; ++x) {
        if (std::find(missing.begin(), missing.end(), std::array{x, y}) != missing.end()) continue;
        const std::uint64_t a = 6 * y + x;
        triangles.push_back({a, a + 1, a + 7});
        triangles.push_back({a, a + 7, a + 6});
      }
    }
    return mesh_boundary(triangles, stand_ins(plane(6).positions));
  };
  const auto one = sheet({{2, 2}});
  REQUIRE(one.size() == 2);
  CHECK(one[0].vertices.size() == 20);
  CHECK(one[1].vertices == Ids{14, 15, 20, 21});
  const auto two = sheet({{2, 2}, {1, 1}});
  REQUIRE(two.size() == 2);
  CHECK(two[1].vertices == Ids{7, 8, 13, 14, 15, 20, 21});
  CHECK(two[1].edges.size() == 8);
}

TEST_CASE("an edge on three triangles is no boundary") {
  Drawing drawing;
  for (int i = 0; i < 5; ++i) drawing.point(i == 1, i == 2 ? 1 : i == 3 ? -1 : 0, i == 4);
  const std::vector<Triangle> fins = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  const auto loops = mesh_boundary(fins, stand_ins(drawing.positions));
  REQUIRE(loops.size() == 1);
  CHECK(loops[0].edges.size() == 6);
  CHECK(std::count(loops[0].edges.begin(), loops[0].edges.end(), std::array<std::uint64_t, 2>{0, 1}) == 0);
}

TEST_CASE("a closed mesh, triangles without area and no triangles have no boundary") {
  Drawing drawing;
  for (int i = 0; i < 4; ++i) drawing.point(i == 1, i == 2, i == 3);
  const std::vector<Triangle> closed = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  CHECK(mesh_boundary(closed, stand_ins(drawing.positions)).empty());
  drawing.point(1, 0);  // at the place of 1
  const std::vector<Triangle> flat = {{0, 1, 4}};
  CHECK(mesh_boundary(flat, stand_ins(drawing.positions)).empty());
  CHECK(mesh_boundary({}, {}).empty());
}

TEST_CASE("the lowest id stands for all points of a place, and one that is not finite for itself") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Eigen::Vector3d> positions = {{1, 0, 0},   {nan, 0, 0},  {0, -0.0, 0}, {1, 0, 0},
                                                  {nan, 0, 0}, {-0.0, 0, 0}, {1, -0.0, 0}};
  CHECK(stand_ins(positions) == Ids{0, 1, 2, 0, 4, 2, 0});
}

TEST_CASE("the spacing is the median of the mean distance to four neighbours") {
  CHECK(median_spacing(plane(20).positions) == Approx(1));
  CHECK(median_spacing(plane(20).scaled(0.5).translated({1e6, 0, 0}).positions) == Approx(0.5));
  CHECK(median_spacing(line(101).positions) == Approx(1.5));  // 1, 1, 2, 2
  CHECK(median_spacing(line(3).positions) == Approx(1.5));    // the ends: 1, 2
  CHECK(median_spacing(line(1).positions) == 0);
  CHECK(median_spacing({}) == 0);
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

TEST_CASE("the distance to a segment is to its nearest place, ends included") {
  const Segment segment{{0, 0, 0}, {10, 0, 0}};
  CHECK(distance_to(segment, {5, 3, 0}) == 3);
  CHECK(distance_to(segment, {-3, 4, 0}) == 5);
  CHECK(distance_to(segment, {13, 0, 4}) == 5);
  CHECK(distance_to({{1, 1, 1}, {1, 1, 1}}, {1, 1, 3}) == 2);
}

TEST_CASE("flagged points are right at a true vertex, or within the radius of a true edge") {
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
    return score_points(flagged, truth, drawing.positions, stands_for, 0.5);
  };

  const PointAccuracy result = score({same, ring[0], ring[1], near, between, far});
  CHECK(result.flagged == 5);
  CHECK(result.truth == 10);
  CHECK(result.by_id.precision == 0.4);
  CHECK(result.by_id.recall == 0.2);
  CHECK(*result.by_id.f1 == Approx(4 / 15.));
  CHECK(result.within_radius.precision == 0.8);
  CHECK(result.within_radius.recall == Approx(0.3));

  CHECK(score(ring).by_id.f1 == 1);
  CHECK(score({far}).by_id.f1 == 0);
  CHECK_FALSE(score({}).by_id.precision);
  CHECK(score({}).by_id.recall == 0);
  CHECK(score({}).by_id.f1 == 0);
  const PointAccuracy none = score_points({}, {}, drawing.positions, stands_for, 1);
  CHECK_FALSE(none.by_id.f1);
}

}  // namespace lacuna::accuracy
