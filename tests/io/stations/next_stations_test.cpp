// SPDX-License-Identifier: Apache-2.0
#include "io/explain/stations/next_stations.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

// Points 0.05 apart on a rectangle from `corner` along x or y, and up.
void add_wall(const Eigen::Vector3d& corner, const Eigen::Vector3d& along, double length, double height,
              std::vector<Eigen::Vector3d>& points) {
  for (double s = 0; s <= length; s += 0.05)
    for (double z = 0; z <= height; z += 0.05)
      points.push_back(corner + s * along + Eigen::Vector3d(0, 0, z));
}

InnerSample on_floor(double x, double y, double area) {
  return {{x, y, 0}, {0, 0, 1}, area};
}

}  // namespace

TEST_CASE("a ray is blocked by points between its ends, and not by those at its ends") {
  std::vector<Eigen::Vector3d> points;
  add_wall({1, 0, 0}, {0, 1, 0}, 2, 2, points);
  const Obstacles obstacles(points, 0.1);
  CHECK(obstacles.block({0, 1, 1}, {2, 1, 1}));
  CHECK(obstacles.block({0.1, 0.4, 1.7}, {1.9, 1.6, 0.2}));
  CHECK_FALSE(obstacles.block({0, 1, 3}, {2, 1, 3}));     // over it
  CHECK_FALSE(obstacles.block({0, 1, 1}, {1, 1, 1}));     // to it
  CHECK_FALSE(obstacles.block({1.02, 1, 1}, {3, 1, 1}));  // from it
  const Eigen::Vector3d far(5e5, 5.4e6, 300);             // voxels there have numbers beyond 2^31
  std::vector<Eigen::Vector3d> moved;
  for (const Eigen::Vector3d& point : points) moved.push_back(point + far);
  const Obstacles fine(moved, 0.001);
  CHECK(fine.block(moved.front() - Eigen::Vector3d(1, 0, 0), moved.front() + Eigen::Vector3d(1, 0, 0)));
  CHECK_FALSE(fine.block(far + Eigen::Vector3d(0, 1, 3), far + Eigen::Vector3d(2, 1, 3)));
  CHECK(obstacles.touch({Eigen::Vector3d(0.9, 0.9, 0.9), Eigen::Vector3d(1.1, 1.1, 1.1)}));
  CHECK_FALSE(obstacles.touch({Eigen::Vector3d(0.2, 0.9, 0.9), Eigen::Vector3d(0.8, 1.1, 1.1)}));
}

TEST_CASE("next stations are chosen by what each adds, within range and angle") {
  std::vector<Eigen::Vector3d> points;
  add_wall({5, 0, 0}, {0, 1, 0}, 10, 3, points);
  const Obstacles obstacles(points, 0.1);
  const std::vector<InnerSample> hidden = {on_floor(2, 5, 3), on_floor(8, 5, 2), on_floor(8, 2, 2),
                                           on_floor(2, 9, 0.01)};
  const std::vector<Eigen::Vector3d> eyes = {{1, 5, 1.6}, {9, 5, 1.6}, {3, 5, 1.6}};
  const SightLimits limits{.range = 6, .least_cosine = 0.1};
  const auto chosen = choose_stations(hidden, eyes, obstacles, limits, 5);
  REQUIRE(chosen.size() == 2);  // the third sees what the first does
  CHECK(chosen[0].index == 1);
  CHECK(chosen[0].eye == eyes[1]);
  CHECK(chosen[0].area == Approx(4));
  CHECK(chosen[1].index == 0);
  CHECK(chosen[1].eye == eyes[0]);
  CHECK(chosen[1].area == Approx(3.01));
  CHECK(choose_stations(hidden, eyes, obstacles, limits, 1).size() == 1);
  CHECK(choose_stations(hidden, eyes, obstacles, {.range = 1, .least_cosine = 0}, 5).empty());
  CHECK(choose_stations(hidden, eyes, obstacles, {.range = 6, .least_cosine = 0.9}, 5).empty());
  CHECK(choose_stations({}, eyes, obstacles, limits, 5).empty());
}

TEST_CASE("two next stations see at least 63 % of what the best two would") {
  const Obstacles nothing({}, 0.1);
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    Random random(seed);
    std::vector<InnerSample> hidden;
    for (int i = 0; i < 200; ++i)
      hidden.push_back(on_floor(random.uniform(0, 20), random.uniform(0, 20), random.uniform()));
    std::vector<Eigen::Vector3d> eyes;
    for (int i = 0; i < 30; ++i) eyes.emplace_back(random.uniform(0, 20), random.uniform(0, 20), 1.6);
    const SightLimits limits{.range = 6, .least_cosine = 0.1};
    double best = 0;
    for (const Eigen::Vector3d& a : eyes) {
      for (const Eigen::Vector3d& b : eyes) {
        double area = 0;
        for (const NextStation& station : choose_stations(hidden, std::vector{a, b}, nothing, limits, 2))
          area += station.area;
        best = std::max(best, area);
      }
    }
    const auto chosen = choose_stations(hidden, eyes, nothing, limits, 2);
    REQUIRE(chosen.size() == 2);
    CHECK(chosen[0].area >= chosen[1].area);
    CHECK(chosen[0].area + chosen[1].area >= 0.632 * best);
    CHECK(chosen[0].area + chosen[1].area <= best * (1 + 1e-12));
  }
}

TEST_CASE("eyes stand over the floor, neither on tables nor in walls") {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> normals;
  const auto add_level = [&](double x0, double y0, double size, double z) {
    for (double x = x0; x < x0 + size; x += 0.05)
      for (double y = y0; y < y0 + size; y += 0.05) points.emplace_back(x, y, z);
    normals.resize(points.size(), {0, 0, -1});
  };
  add_level(0, 0, 6, 0);
  add_level(2, 2, 1.5, 0.75);
  add_level(0, 0, 6, 2.7);
  add_wall({4, 0, 0}, {0, 1, 0}, 6, 2.7, points);
  normals.resize(points.size(), {1, 0, 0});
  const Obstacles obstacles(points, 0.1);
  const auto eyes =
      eyes_over_floor(points, normals, obstacles, {.height = 1.6, .grid = 0.5, .clearance = 0.3});
  CHECK(eyes.size() > 60);
  for (const Eigen::Vector3d& eye : eyes) {
    CHECK(eye.z() == Approx(1.6));
    CHECK(std::abs(eye.x() - 4) > 0.25);
    CHECK((eye.head<2>() - Eigen::Vector2d(2.75, 2.75)).cwiseAbs().maxCoeff() > 0.6);
  }
}

}  // namespace lacuna::io
