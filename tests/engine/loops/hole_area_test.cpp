// SPDX-License-Identifier: Apache-2.0
// How much surface is missing: places of several holes count once.
#include "engine/config/job.hpp"
#include "engine/loops/nest_loops.hpp"
#include "tests/support/loop_points.hpp"

namespace lacuna {
namespace {

using test::DrawnLoop;
using test::square;

constexpr LoopKind kHole = LoopKind::kHole, kOuter = LoopKind::kOuter;

MeasuredLoops with_areas(const std::vector<DrawnLoop>& drawn) {
  const ScratchFolder scratch;
  MeasuredLoops loops = test::measured(drawn, scratch.path());
  std::vector<std::size_t> all(drawn.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const double area = measure_hole_area(loops, all, {scratch.path(), nullptr}, workers_of({}));
  const auto add = [](double sum, const LoopMeasures& loop) { return sum + loop.own_area; };
  CHECK(std::accumulate(loops.measures.begin(), loops.measures.end(), 0.0, add) == Approx(area));
  return loops;
}

double area_of(const std::vector<DrawnLoop>& drawn) {
  double area = 0;
  for (const LoopMeasures& loop : with_areas(drawn).measures) area += loop.own_area;
  return area;
}

TEST_CASE("holes beside each other add up, and outer curves do not count") {
  CHECK(area_of({square(1, kHole), square(2, kHole, {9, 0, 0}), square(20, kOuter)}) == Approx(20));
  CHECK(area_of({}) == 0);
}

TEST_CASE("a place of several holes counts once") {
  CHECK(area_of({square(2, kHole), square(1, kHole, {0.5, 0.5, 0})}) == Approx(16));
  CHECK(area_of({square(2, kHole), square(2, kHole, {0.01, 0, 0.1})}) == Approx(16).epsilon(0.05));
}

TEST_CASE("the own areas of holes add up: a place of several belongs to the largest of them") {
  const auto loops = with_areas({square(2, kHole), square(1, kHole, {2, 0, 0}), square(20, kOuter)}).measures;
  CHECK(loops[0].own_area == Approx(16));
  CHECK(loops[1].own_area == Approx(2).epsilon(0.15));
  CHECK(loops[2].own_area == 0);
}

TEST_CASE("holes of surfaces above each other, or at right angles, do not overlap") {
  CHECK(area_of({square(2, kHole), square(1, kHole, {0, 0, 2})}) == Approx(20));
  DrawnLoop wall = square(1, kHole);
  for (Eigen::Vector3d& point : wall.points) point = Eigen::Vector3d(point.x(), 0, point.y());
  CHECK(area_of({square(2, kHole), wall}) == Approx(20));
}

}  // namespace
}  // namespace lacuna
