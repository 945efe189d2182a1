// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/measure_loops.hpp"

#include "tests/support/reference.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

using Eigen::Vector3d;
using test::loop_point;

// n points of a circle about the z axis; `outwards`: where the surface lies, 1 outside, -1 inside.
Loop circle(int n, double radius, float outwards) {
  Loop loop;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    const Vector3d at(std::cos(angle), std::sin(angle), 0);
    loop.push_back(loop_point(std::uint64_t(i), radius * at, 0.1f * outwards * at.cast<float>(), 0.75f));
  }
  return loop;
}

Loop square(float outwards) {
  Loop loop;
  for (const Vector3d& corner :
       {Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(2, 2, 0), Vector3d(0, 2, 0)}) {
    const Eigen::Vector3f out = (corner - Vector3d(1, 1, 0)).cast<float>();
    const auto number = static_cast<float>(loop.size());
    loop.push_back(loop_point(loop.size(), corner, outwards * out, 0.25f * number));
  }
  return loop;
}

void move(Loop& loop, const Vector3d& by) {
  for (LoopPoint& p : loop) test::move_to(p, p.position() + by);
}

TEST_CASE("a square of side two has perimeter 8, area 4, diameter 2 sqrt 2") {
  const LoopMeasures m = measure_loop(square(1), 1.0);
  CHECK(m.kind == LoopKind::kHole);
  CHECK(m.points == 4);
  CHECK(m.perimeter == 8);
  CHECK(m.area == 4);
  CHECK(m.diameter == std::sqrt(8.0));
  CHECK(m.centroid == Vector3d(1, 1, 0));
  CHECK(m.normal == Vector3d(0, 0, 1));
  CHECK(m.planarity == Approx(1));
  CHECK(m.mean_probability == 0.375);
  CHECK(m.tiles == 4);  // corners at 0 and 2: cubes 0 and 2
}

TEST_CASE("the surface outside makes a hole, inside an outer curve, whatever the direction of the loop") {
  for (const bool reversed : {false, true}) {
    for (const int n : {4, 5, 30, 1000}) {
      Loop hole = circle(n, 3, 1), rim = circle(n, 3, -1);
      if (reversed) {
        std::reverse(hole.begin(), hole.end());
        std::reverse(rim.begin(), rim.end());
      }
      CHECK(measure_loop(hole, 1).kind == LoopKind::kHole);
      CHECK(measure_loop(rim, 1).kind == LoopKind::kOuter);
      CHECK(measure_loop(hole, 1).normal.z() == Approx(1));
    }
  }
}

TEST_CASE("the edge of a dented outline is an outer curve though parts of it bend inwards") {
  Loop star = circle(100, 3, -1);
  for (std::size_t i = 0; i < star.size(); ++i)
    test::move_to(star[i], (1 + 0.3 * std::cos(0.1 * std::numbers::pi * double(i))) * star[i].position());
  CHECK(measure_loop(star, 1).kind == LoopKind::kOuter);
}

TEST_CASE("measures do not suffer from coordinates in the millions") {
  Loop far = circle(200, 0.01, -1);
  move(far, {1e6, -1e6, 2e6});
  const LoopMeasures near = measure_loop(circle(200, 0.01, -1), 1), m = measure_loop(far, 1);
  CHECK(m.kind == LoopKind::kOuter);
  CHECK(m.perimeter == Approx(near.perimeter).epsilon(1e-6));
  CHECK(m.area == Approx(near.area).epsilon(1e-6));
  CHECK(m.planarity == Approx(1).margin(1e-6));
  CHECK((m.centroid - Vector3d(1e6, -1e6, 2e6)).norm() < 1e-9);
}

TEST_CASE("a loop that encloses nothing has area 0, no normal, and finite measures") {
  Loop flat;
  for (const double x : {0.0, 1.0, 2.0}) flat.push_back(loop_point(flat.size(), {x, 0, 0}));
  const LoopMeasures m = measure_loop(flat, 1);
  CHECK(m.area == 0);
  CHECK(m.normal == Vector3d(0, 0, 0));
  CHECK(m.perimeter == 4);
  CHECK(m.diameter == 2);
  CHECK(std::isfinite(m.planarity));
}

TEST_CASE("planarity falls with the thickness of the loop") {
  Loop bent = circle(100, 2, 1);
  for (LoopPoint& p : bent) p.z = 0.5 * p.x * p.y;
  const double planarity = measure_loop(bent, 1).planarity;
  CHECK(planarity < 0.75);
  CHECK(planarity >= 0);
}

TEST_CASE("the diameter is that of all pairs") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    Loop loop;
    const std::int64_t n = random.whole(3, 400);
    Vector3d at(0, 0, 0);
    for (std::int64_t i = 0; i < n; ++i) {
      at += random.direction() * random.uniform(0, 2);
      loop.push_back(loop_point(std::uint64_t(i), at));
    }
    double largest = 0;
    for (const LoopPoint& a : loop) {
      for (const LoopPoint& b : loop)
        largest = std::max(largest, (a.position() - b.position()).squaredNorm());
    }
    CHECK(diameter(loop) == std::sqrt(largest));
  }
}

// ---- Loops of a scan

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
  CHECK(select_loops(loops, {.min_points = 10}) == Indices{0, 2, 3});
  CHECK(select_loops(loops, {.holes_only = true}) == Indices{1, 2, 3});
  CHECK(select_loops(loops, {.min_perimeter = 5, .min_points = 10, .holes_only = true}) == Indices{3});
  CHECK(select_loops({}, {}).empty());
}

}  // namespace
}  // namespace lacuna
