// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/measure_loops.hpp"

#include "tests/support/loop_points.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

Cloud four_loops() {
  return plane(40)
      .punched({12, 20}, 5)
      .punched({28, 20}, 4)
      .jittered(0.2, 3)
      .joined(plane(12).jittered(0.2, 4).translated({60, 0, 5}))
      .shuffled(2);
}

bool same(const LoopMeasures& a, const LoopMeasures& b) {
  return a.kind == b.kind && a.points == b.points && a.perimeter == b.perimeter && a.area == b.area &&
         a.diameter == b.diameter && a.centroid == b.centroid && a.normal == b.normal &&
         a.planarity == b.planarity && a.mean_probability == b.mean_probability && a.tiles == b.tiles;
}

// `memory`: bytes for the global stage while loops are measured; 0: as many as the run gives it.
MeasuredLoops measured_loops(TiledScan& scan, std::uint64_t memory = 0) {
  paper::PaperBoundary boundary(scan.store.tiling(), scan.config.spanning, scan.job.spill, scan.job.workers);
  const TileOutputs outputs =
      scan.evaluate({[&](const EvaluatedTile& tile, TileOutput& output) { boundary.emit(tile, output); }});
  FoundLoops found = scan.find_loops(boundary, outputs);
  const std::size_t count = found.loops.size();
  ChosenLoops chosen;
  for (std::uint32_t loop = 0; loop < count; ++loop) chosen.chosen.push_back({0, loop});
  chosen.levels.push_back(std::move(found.loops));
  if (memory > 0) scan.job.workers.memory.work = memory;
  const std::vector<LoopTrack> tracks(count);
  return measure_loops(std::move(chosen), tracks, scan.totals(outputs).mean_edge_length(), scan.job.spill,
                       scan.job.workers, scan.job.phases);
}

TEST_CASE(
    "points of a loop have their places and what the evaluation said, however few loops fit in memory") {
  const Cloud cloud = four_loops();
  const reference::Detection plain = reference::detect(cloud.positions, {}, with_paper_loops({}));
  REQUIRE(plain.loops.size() == 4);
  for (const std::uint64_t memory : {1 << 30, 20'000, 1}) {
    INFO(memory << " bytes");
    TiledScan scan(cloud, tiled(with_paper_loops({}), 50));
    const MeasuredLoops measured = measured_loops(scan, memory);
    REQUIRE(measured.measures.size() == 4);
    REQUIRE(measured.loops.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      Loop loop;
      measured.loops.for_each_point(i, [&](const LoopPoint& p) { loop.push_back(p); });
      std::size_t wrong = 0;
      for (std::size_t j = 0; j < loop.size(); ++j) {
        const LoopPoint& p = loop[j];
        const reference::Point& q = plain.points[value(p.id)];
        wrong += p.position() != cloud.positions[value(p.id)];
        wrong += std::abs(p.probability - q.probability) > 1e-6;
        wrong += (test::surface_of(p).cast<double>() - q.surface).norm() > 1e-5;
      }
      CHECK(wrong == 0);
      CHECK(same(measured.measures[i], measure_loop(loop, 64)));  // 64 mean edges of about 1
    }
  }
}

TEST_CASE("loops are selected by points, perimeter and kind, limits included") {
  const std::vector<LoopMeasures> loops = {{.kind = LoopKind::kOuter, .points = 100, .perimeter = 50},
                                           {.kind = LoopKind::kHole, .points = 9, .perimeter = 5},
                                           {.kind = LoopKind::kHole, .points = 10, .perimeter = 4},
                                           {.kind = LoopKind::kHole, .points = 30, .perimeter = 20}};
  using Indices = std::vector<std::size_t>;
  CHECK(select_loops(loops, {}) == Indices{0, 1, 2, 3});
  CHECK(select_loops(loops, {.min_perimeter = 5}) == Indices{0, 1, 3});
  CHECK(select_loops(loops, {.max_perimeter = 20}) == Indices{1, 2, 3});
  const std::vector<LoopMeasures> areas = {{.area = 1}, {.area = 2}, {.area = 3}};
  CHECK(select_loops(areas, {.min_area = 2}) == Indices{1, 2});
  CHECK(select_loops(areas, {.max_area = 2}) == Indices{0, 1});
  CHECK(select_loops(loops, {.min_points = 10}) == Indices{0, 2, 3});
  CHECK(select_loops(loops, {.holes_only = true}) == Indices{1, 2, 3});
  CHECK(
      select_loops(loops, {.min_perimeter = 5, .max_perimeter = 20, .min_points = 10, .holes_only = true}) ==
      Indices{3});
  CHECK(select_loops({}, {}).empty());
}

}  // namespace
}  // namespace lacuna
