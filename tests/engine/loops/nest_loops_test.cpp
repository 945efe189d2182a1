// SPDX-License-Identifier: Apache-2.0
// Loops in loops; and how much surface is missing, where places of several holes count once.
#include "engine/loops/nest_loops.hpp"

#include "engine/config/job.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

using Eigen::Vector3d;
using Parents = std::vector<std::int64_t>;
using Line = std::vector<Vector3d>;

using test::DrawnLoop;
using test::square;

constexpr LoopKind kHole = LoopKind::kHole, kOuter = LoopKind::kOuter;

// `memory`: bytes for the step; 0: as many as the run gives it.
std::vector<LoopMeasures> nested(const std::vector<DrawnLoop>& drawn, std::uint64_t memory = 0) {
  const ScratchFolder scratch;
  NoProgress progress;
  const Config config;
  Job job(config, scratch.path(), progress);
  if (memory > 0) job.workers.memory.work = memory;
  MeasuredLoops loops = test::measured(drawn, scratch.path());
  nest_loops(loops, job.spill, job.workers, job.phases);
  return loops.measures;
}

Parents parents(const std::vector<LoopMeasures>& loops) {
  Parents parents;
  for (const LoopMeasures& loop : loops) parents.push_back(loop.parent);
  return parents;
}

// The outer curve of a plane, a hole, its island, a hole in the island, and an island in this. And a hole on
// its own.
std::vector<DrawnLoop> nest_of_five() {
  return {square(20, kOuter), square(8, kHole, {2, 0, 0}),        square(5, kOuter, {2, 1, 0}),
          square(1, kOuter),  square(2, kHole, {0.5, 0.5, 0}, 9), square(3, kHole, {-14, -14, 0})};
}

TEST_CASE("loops that are nested have the smallest one around as parent, and holes lose their islands") {
  const std::vector<LoopMeasures> loops = nested(nest_of_five());
  CHECK(parents(loops) == Parents{-1, 0, 1, 4, 2, 0});
  const std::vector<double> areas = {1600, 256 - 100, 100, 4, 16 - 4, 36};
  for (std::size_t i = 0; i < areas.size(); ++i) CHECK(loops[i].area == Approx(areas[i]));
}

TEST_CASE("the parents are the same in any place and direction, whatever the memory") {
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(4e5, 5e6, 300) * Eigen::AngleAxisd(1.2, Vector3d(3, -1, 2).normalized());
  std::vector<DrawnLoop> drawn = nest_of_five();
  for (DrawnLoop& loop : drawn)
    for (Vector3d& point : loop.points) point = motion * point;
  std::reverse(drawn[2].points.begin(), drawn[2].points.end());
  for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{4000}, std::uint64_t{1}}) {
    const std::vector<LoopMeasures> loops = nested(drawn, memory);
    CHECK(parents(loops) == Parents{-1, 0, 1, 4, 2, 0});
    CHECK(loops[1].area == Approx(156));
  }
}

TEST_CASE("a loop next to another one, or across its edge, is not inside") {
  CHECK(parents(nested({square(3, kHole), square(1, kOuter, {5, 0, 0})})) == Parents{-1, -1});
  CHECK(parents(nested({square(3, kHole), square(1, kOuter, {3, 0, 0})})) == Parents{-1, -1});
  // In the notch of a U.
  const DrawnLoop notched{
      {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {6, 9, 0}, {6, 3, 0}, {3, 3, 0}, {3, 9, 0}, {0, 9, 0}}};
  CHECK(parents(nested({notched, square(1, kOuter, {4.5, 6, 0})})) == Parents{-1, -1});
  CHECK(parents(nested({notched, square(1, kOuter, {1.5, 6, 0})})) == Parents{-1, 0});
}

TEST_CASE("a surface steeply above a hole is no island, a low one is") {
  const DrawnLoop hole = square(5, kHole);
  CHECK(parents(nested({hole, square(2, kOuter, {0, 0, 1})})) == Parents{-1, 0});
  CHECK(parents(nested({hole, square(2, kOuter, {0, 0, 4})})) == Parents{-1, -1});
  CHECK(parents(nested({hole, square(4.9, kOuter, {0, 0, 0.5})})) == Parents{-1, -1});  // a table
  CHECK(parents(nested({hole, square(4.9, kOuter)})) == Parents{-1, 0});
}

TEST_CASE("the parent of a hole lies in the same sheet, though another sheet's curve is smaller") {
  const DrawnLoop hole = square(2, kHole, {0, 0, 0}, 9), outer = square(12, kOuter);
  CHECK(parents(nested({outer, square(9, kOuter, {0, 0, 3}), hole})) == Parents{-1, -1, 0});
  CHECK(parents(nested({square(12, kOuter, {0, 0, 2}), square(9, kOuter, {0, 0, 3}), hole})) ==
        Parents{-1, -1, 1});  // both are far
}

TEST_CASE("an upright loop is not inside a level one") {
  DrawnLoop upright = square(1, kOuter);
  for (Vector3d& point : upright.points) point = {point.x(), 0, point.y()};
  CHECK(parents(nested({square(5, kHole), upright})) == Parents{-1, -1});
}

TEST_CASE("a loop directly inside one of its kind has no parent, and counts once") {
  const std::vector<LoopMeasures> loops = nested({square(9, kHole), square(5, kOuter), square(3, kOuter)});
  CHECK(parents(loops) == Parents{-1, 0, -1});
  CHECK(loops[0].area == Approx(324 - 100));
}

TEST_CASE("loops that enclose nothing have no parents and are none") {
  CHECK(parents(nested({})).empty());
  const DrawnLoop flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, kOuter};
  CHECK(parents(nested({square(5, kHole), flat, flat})) == Parents{-1, -1, -1});
}

TEST_CASE("parents are reported loops, and inner rings are reported ones or islands") {
  const std::vector<LoopMeasures> found = nested(nest_of_five());
  using Rings = std::vector<std::vector<InnerRing>>;
  const NestedReport all = report_nested(found, {0, 1, 2, 3, 4, 5});
  CHECK(parents(all.loops) == Parents{-1, 0, 1, 4, 2, 0});
  CHECK(all.inner_rings == Rings{{{1, 20}, {5, 20}}, {{2, 20}}, {{4, 36}}, {}, {{3, 20}}, {}});
  const NestedReport holes = report_nested(found, {1, 4, 5});
  CHECK(parents(holes.loops) == Parents{-1, -1, -1});
  CHECK(holes.inner_rings == Rings{{{3, 20}}, {{4, 20}}, {}});
  CHECK(holes.found == std::vector<std::size_t>{1, 4, 5, 2, 3});
  const NestedReport outer = report_nested(found, {0, 2, 5});
  CHECK(parents(outer.loops) == Parents{-1, -1, 0});
  CHECK(outer.inner_rings == Rings{{{2, 20}}, {}, {}});
}

TEST_CASE("an island in a hole of a scan: its area is not the hole's, by both methods and any tiling") {
  const Vector3d centre(20, 20, 0);
  Cloud cloud;
  for (const Vector3d& p : plane(41).jittered(0.2, 5).positions) {
    const double r = (p - centre).head<2>().norm();
    if (r < 5 || r > 12) cloud.positions.push_back(p);
  }
  cloud = cloud.rotated({1, 2, 0}, 40);
  for (const Config& config : {Config{}, with_paper_loops({})}) {
    const Detected run = run_engine(cloud, config);
    const ReportedLoop *hole = nullptr, *island = nullptr;
    std::size_t at = 0, hole_at = 0;
    for (const ReportedLoop& loop : run.loops) {
      if (loop.measures.kind == kHole && loop.measures.diameter > 20) hole = &loop, hole_at = at;
      if (loop.measures.kind == kOuter && loop.measures.diameter < 12) island = &loop;
      ++at;
    }
    REQUIRE(hole);
    REQUIRE(island);
    CHECK(island->measures.parent == static_cast<std::int64_t>(hole_at));
    CHECK(hole->measures.area == Approx(std::numbers::pi * (12.5 * 12.5 - 4.5 * 4.5)).epsilon(0.05));
    CHECK(run.bytes() == run_engine(cloud, tiled(config, 300, 3)).bytes());
  }
}

// ---- The area that is missing

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
