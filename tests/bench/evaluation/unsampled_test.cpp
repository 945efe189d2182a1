// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/unsampled.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"
#include "tools/matching/true_loops.hpp"

namespace lacuna::evaluation {
using namespace matching;

namespace {

// Returns the points of a cloud between two distances from a vertical line, in order around it.
LoopIds ring(const Cloud& cloud, const Eigen::Vector2d& centre, double nearest, double farthest) {
  LoopIds ids;
  const auto from_centre = [&](std::uint64_t id) -> Eigen::Vector2d {
    return cloud.positions[id].head<2>() - centre;
  };
  for (std::uint64_t id = 0; id < cloud.size(); ++id) {
    const double distance = from_centre(id).norm();
    if (distance >= nearest && distance < farthest) ids.push_back(id);
  }
  std::sort(ids.begin(), ids.end(), [&](std::uint64_t a, std::uint64_t b) {
    return std::atan2(from_centre(a).y(), from_centre(a).x()) <
           std::atan2(from_centre(b).y(), from_centre(b).x());
  });
  return ids;
}

// Two triangles at a height.
Surface square(double low, double high, double z = 0) {
  return {.positions = {{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}},
          .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

// The share of the loop's points at an unsampled place.
double share(const Cloud& cloud, const LoopIds& loop, const Surface& surface, double spacing = 1) {
  const auto stands_for = stand_ins(cloud.positions);
  const std::vector<LoopIds> loops = {loop};
  const auto points = points_at_unsampled(
      loops, surface, {.positions = cloud.positions, .stand_ins = stands_for, .spacing = spacing});
  return static_cast<double>(std::count(points[0].begin(), points[0].end(), true)) /
         static_cast<double>(loop.size());
}

}  // namespace

TEST_CASE("a loop around a gap in the points lies at an unsampled place, if the surface is there") {
  const Cloud cloud = plane(30).punched({15, 15}, 4);
  const LoopIds loop = ring(cloud, {15, 15}, 4, 5);
  CHECK(share(cloud, loop, square(0, 29)) == 1);
  // Not where the surface lies outside of the gap, or under it.
  CHECK(share(cloud, loop, square(0, 10)) == 0);
  CHECK(share(cloud, loop, square(0, 29, 4.5)) == 0);
  CHECK(share(cloud, loop, {}) == 0);
}

TEST_CASE("a loop around points lies at no unsampled place") {
  const Cloud cloud = plane(30).punched({15, 15}, 4);
  CHECK(share(cloud, ring(cloud, {7, 7}, 3, 4), square(0, 29)) == 0);
  // Around the gap, but three spacings away.
  CHECK(share(cloud, ring(cloud, {15, 15}, 8, 9), square(0, 29)) == 0);
}

TEST_CASE("a gap of one and a half spacings is none, at the spacing of its edge") {
  const Cloud four = plane(30).punched({14.5, 14.5}, 1);  // 2 x 2 points: 1.58 to the nearest
  CHECK(share(four, ring(four, {14.5, 14.5}, 1, 2.2), square(0, 29)) == 0);
  const Cloud nine = plane(30).punched({15, 15}, 1.5);  // 3 x 3 points: 2 to the nearest
  CHECK(share(nine, ring(nine, {15, 15}, 1.5, 2.9), square(0, 29)) == 1);

  // Where points are three spacings apart, so must a gap be.
  const Cloud coarse = plane(30).scaled(3);
  CHECK(share(coarse, ring(coarse, {43.5, 43.5}, 1, 3), square(0, 87)) == 0);
  const Cloud punched = plane(30).punched({15, 15}, 4).scaled(3);
  CHECK(share(punched, ring(punched, {45, 45}, 12, 15), square(0, 87)) == 1);
}

TEST_CASE("the triangles of the surface do not matter, and neither do those that are not finite") {
  const Cloud cloud = plane(30).punched({15, 15}, 4).translated({1e5, 0, 0});
  const LoopIds loop = ring(cloud, {1e5 + 15, 15}, 4, 5);
  Surface fine;
  for (std::uint64_t y = 0; y < 100; ++y) {
    for (std::uint64_t x = 0; x < 100; ++x) {
      fine.positions.emplace_back(1e5 + 0.3 * static_cast<double>(x), 0.3 * static_cast<double>(y), 0);
      const std::uint64_t a = 100 * y + x;
      if (x == 99 || y == 99) continue;
      fine.triangles.push_back({a, a + 1, a + 101});
      fine.triangles.push_back({a, a + 101, a + 100});
    }
  }
  CHECK(share(cloud, loop, fine) == 1);
  CHECK(share(cloud, loop, square(-1e7, 1e7)) == 1);
  // A strip across the gap serves the points at its ends.
  const Surface strip = {.positions = {{1e5, 15, 0}, {1e5 + 30, 15, 0}, {1e5 + 30, 15.1, 0}},
                         .triangles = {{0, 1, 2}}};
  const double served = share(cloud, loop, strip);
  CHECK((served > 0.2 && served < 0.7));
  fine.positions.assign(fine.positions.size(),
                        Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  CHECK(share(cloud, loop, fine) == 0);
  CHECK(share(cloud, loop, square(-1e100, 1e100)) == 1);
  CHECK(share(cloud, loop, square(-1e300, 1e300)) <= 1);  // squares of such lengths are infinite
}

TEST_CASE("loops without points, without spacing and off the scan's finite points have no unsampled places") {
  Cloud cloud = plane(30).punched({15, 15}, 4);
  const LoopIds loop = ring(cloud, {15, 15}, 4, 5);
  CHECK(share(cloud, loop, square(0, 29), 0) == 0);
  CHECK(points_at_unsampled({}, square(0, 29), {}).empty());
  cloud.positions[loop[0]].x() = std::numeric_limits<double>::infinity();
  CHECK(share(cloud, loop, square(0, 29)) == 0);
}

}  // namespace lacuna::evaluation
