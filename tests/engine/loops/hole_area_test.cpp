// SPDX-License-Identifier: Apache-2.0
// How much surface is missing: places of several holes count once.
#include "engine/loops/hole_area.hpp"

#include "engine/loops/nest_loops.hpp"
#include "tests/support/measured_loops.hpp"
#include "tests/support/scratch_folder.hpp"

#include <numeric>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using test::DrawnLoop;
using test::square;

constexpr LoopKind kHole = LoopKind::kHole, kOuter = LoopKind::kOuter;

struct Reported {
  double area;                     // of all of them
  std::vector<std::size_t> loops;  // that are left
  std::vector<double> own_areas;   // of these
};

Reported reported(const std::vector<DrawnLoop>& drawn) {
  const test::ScratchFolder scratch;
  NoProgress progress;
  const Config config;
  Job job(config, scratch.path(), progress);
  MeasuredLoops found = test::measured(drawn, job);
  nest_loops(found, job);
  Reported left{0, std::vector<std::size_t>(drawn.size()), {}};
  std::iota(left.loops.begin(), left.loops.end(), std::size_t{0});
  left.area = measure_hole_area(found, left.loops, job);
  for (const std::size_t loop : left.loops) left.own_areas.push_back(found.measures[loop].own_area);
  CHECK(std::accumulate(left.own_areas.begin(), left.own_areas.end(), 0.0) == Approx(left.area));
  return left;
}

double area_of(const std::vector<DrawnLoop>& drawn) {
  return reported(drawn).area;
}

TEST_CASE("holes beside each other add up, and outer curves do not count") {
  CHECK(area_of({square(1, kHole), square(2, kHole, {9, 0, 0}), square(20, kOuter)}) == Approx(20));
  CHECK(area_of({}) == 0);
}

TEST_CASE("a place of several holes counts once") {
  CHECK(area_of({square(2, kHole), square(1, kHole, {0.5, 0.5, 0})}) == Approx(16));
  CHECK(area_of({square(2, kHole), square(2, kHole, {0.01, 0, 0.1})}) == Approx(16).epsilon(0.05));
  CHECK(area_of({square(2, kHole), square(1, kHole, {2, 0, 0})}) == Approx(18).epsilon(0.05));
}

TEST_CASE("the own areas of holes add up: a place of several belongs to the largest of them") {
  const Reported left = reported({square(2, kHole), square(1, kHole, {2, 0, 0}), square(20, kOuter)});
  REQUIRE(left.loops.size() == 3);
  CHECK(left.own_areas[0] == Approx(16));
  CHECK(left.own_areas[1] == Approx(2.0).epsilon(0.15));
  CHECK(left.own_areas[2] == 0);
}

TEST_CASE("a hole that lies mostly in a larger one is not reported") {
  const auto loops_of = [](const std::vector<DrawnLoop>& drawn) { return reported(drawn).loops; };
  using Loops = std::vector<std::size_t>;
  CHECK(loops_of({square(1, kHole, {1.4, 0, 0}), square(2, kHole)}) == Loops{1});
  CHECK(loops_of({square(1, kHole, {2, 0, 0}), square(2, kHole)}) == Loops{0, 1});
  CHECK(loops_of({square(2, kHole, {0.01, 0, 0.1}), square(2, kHole), square(1, kOuter, {9, 0, 0})}) ==
        Loops{1, 2});
  // A lake on an island of a lake is no part of it.
  CHECK(loops_of({square(9, kHole), square(5, kOuter), square(2, kHole)}) == Loops{0, 1, 2});
}

TEST_CASE("holes of surfaces above each other, or at right angles, do not overlap") {
  CHECK(area_of({square(2, kHole), square(1, kHole, {0, 0, 2})}) == Approx(20));
  DrawnLoop wall = square(1, kHole);
  for (Eigen::Vector3d& point : wall.points) point = Eigen::Vector3d(point.x(), 0, point.y());
  CHECK(area_of({square(2, kHole), wall}) == Approx(20));
}

}  // namespace
}  // namespace lacuna
