// SPDX-License-Identifier: Apache-2.0
// How sure a loop is: what its evidence adds, and how far it stands out of the gaps around it.
#include "engine/loops/rate_loops.hpp"

#include "engine/loops/confidence.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

constexpr double kRadius = 10;

// A plane with a round hole of that radius in its middle.
Cloud punched_plane() {
  return plane(60).punched({29.5, 29.5}, kRadius).jittered(0.2, 1);
}

// Points `step` apart within a radius about the middle of the hole, at a height.
Cloud with_patch(Cloud cloud, double radius, double step, double height = 0) {
  for (double y = -radius; y <= radius; y += step) {
    for (double x = -radius; x <= radius; x += step)
      if (std::hypot(x, y) <= radius) cloud.positions.emplace_back(29.5 + x, 29.5 + y, height);
  }
  return cloud;
}

// Returns the measures of the hole of that radius.
LoopMeasures hole_of(const Cloud& cloud) {
  Config config;
  config.selection.min_confidence = 0;
  std::vector<LoopMeasures> holes;
  for (const ReportedLoop& loop : run_engine(cloud, config).loops) {
    if (loop.measures.kind == LoopKind::kHole && std::abs(loop.measures.diameter - 2 * kRadius) < 4)
      holes.push_back(loop.measures);
  }
  REQUIRE(holes.size() == 1);
  return holes[0];
}

TEST_CASE("a hole stands out of the gaps around it, and the less the more points lie in it") {
  const LoopMeasures empty = hole_of(punched_plane());
  // A radius of 10 spacings over a gap of half a diagonal of the grid.
  CHECK(empty.track.evidence.prominence > 8);
  CHECK(empty.track.evidence.prominence < 16);
  CHECK(empty.track.evidence.width == Approx(kRadius).margin(1.5));
  CHECK(empty.track.evidence.compactness == Approx(1 / (2 * std::numbers::pi)).margin(0.04));
  CHECK(empty.track.confidence > 0.95);
  const LoopMeasures sparse = hole_of(with_patch(punched_plane(), kRadius, 3)),
                     sparser = hole_of(with_patch(punched_plane(), kRadius, 5));
  CHECK(sparse.track.evidence.prominence < sparser.track.evidence.prominence);
  CHECK(sparser.track.evidence.prominence < empty.track.evidence.prominence / 2);
  CHECK(sparse.track.confidence < sparser.track.confidence);
  CHECK(sparser.track.confidence < empty.track.confidence);
}

TEST_CASE("a hole with an island is as prominent as the ring around the island is wide") {
  const double prominence = hole_of(with_patch(punched_plane(), 5, 1)).track.evidence.prominence;
  CHECK(prominence > 1.5);
  CHECK(prominence < 5);
  CHECK(hole_of(with_patch(punched_plane(), 3, 1)).track.confidence > 0.9);
}

TEST_CASE("what lies far before or behind a hole leaves it prominent") {
  const auto of = [](const Cloud& cloud) { return hole_of(cloud).track.evidence.prominence; };
  CHECK(of(with_patch(punched_plane(), 8, 1, 12)) == of(punched_plane()));
}

TEST_CASE("the height of a hole follows its loop: points on a cylinder fill a hole in it") {
  const auto bent = [](Cloud cloud) {
    for (Eigen::Vector3d& p : cloud.positions)
      p = {25 * std::sin((p.x() - 29.5) / 25), p.y(), 25 * std::cos((p.x() - 29.5) / 25)};
    return cloud;
  };
  CHECK(hole_of(bent(punched_plane())).track.evidence.prominence > 8);
  CHECK(hole_of(bent(with_patch(punched_plane(), kRadius, 3))).track.evidence.prominence < 4);
}

TEST_CASE(
    "a turn and a move of the scan change a prominence by less than half an octave, as pixels are half a "
    "spacing") {
  const double before = hole_of(punched_plane()).track.evidence.prominence;
  const Cloud moved = punched_plane().rotated({1, 2, 3}, 40).translated({456'000, 5'432'000, 100});
  CHECK(hole_of(moved).track.evidence.prominence == Approx(before).epsilon(0.4));
}

// The box of the loop and its surroundings reaches to 9.985, the raster to 10.
TEST_CASE("all points over the raster count for a prominence, whatever cells they are in") {
  Cloud ring;
  std::vector<LoopPoint> loop;
  for (int i = 0; i < 40; ++i) {
    const double angle = i * std::numbers::pi / 20;
    ring.positions.emplace_back(5 * std::cos(angle), 5 * std::sin(angle), 0);
    LoopPoint& point = loop.emplace_back();
    point.x = ring.positions.back().x();
    point.y = ring.positions.back().y();
  }
  Cloud framed = ring;
  for (double along = -9.5; along <= 9.5; along += 0.5) {
    for (const double side : {-9.995, 9.995}) {
      framed.positions.emplace_back(side, along, 0);
      framed.positions.emplace_back(along, side, 0);
    }
  }
  const auto prominence_in = [&](const Cloud& cloud) {
    const TiledScan scan(cloud, tiled({}, 4));
    Scratch scratch(scan.job.spill.folder, 1 << 20);
    return prominence(scan.store, loop, shape_of(loop, scratch), 1, scratch);
  };
  CHECK(prominence_in(framed) > 1.1 * prominence_in(ring));
}

TEST_CASE("outer curves have no prominence") {
  for (const ReportedLoop& loop : run_engine(punched_plane(), {}).loops)
    if (loop.measures.kind == LoopKind::kOuter) CHECK(loop.measures.track.evidence.prominence == 0);
}

TEST_CASE("log-odds rise with each evidence of a loop, and fall with gaps of the sampling") {
  const LoopKind kind = GENERATE(LoopKind::kHole, LoopKind::kOuter);
  const LoopEvidence plain{
      .surface = 0.8, .sampling_gap = 0.55, .kind = kind, .width = 4, .compactness = 0.1, .prominence = 2};
  const auto with = [&](auto change) {
    LoopEvidence changed = plain;
    change(changed);
    return log_odds(changed);
  };
  const double before = log_odds(plain);
  CHECK(with([](LoopEvidence& e) { e.width = 5; }) > before);
  CHECK(with([](LoopEvidence& e) { e.persistence = 1; }) > before);
  CHECK(with([](LoopEvidence& e) { e.sampling_gap = 0.6; }) < before);
  // Beyond these, a number says nothing more.
  CHECK(with([](LoopEvidence& e) { e.width = 5; }) == with([](LoopEvidence& e) { e.width = 800; }));
  CHECK(with([](LoopEvidence& e) { e.width = 0.5; }) == with([](LoopEvidence& e) { e.width = 0; }));
  CHECK(with([](LoopEvidence& e) { e.persistence = 2; }) == with([](LoopEvidence& e) { e.persistence = 9; }));
  if (kind == LoopKind::kHole) {
    CHECK(with([](LoopEvidence& e) { e.surface = 0.9; }) > before);
    CHECK(with([](LoopEvidence& e) { e.compactness = 0.15; }) > before);
    CHECK(with([](LoopEvidence& e) { e.prominence = 3; }) > before);
    CHECK(with([](LoopEvidence& e) { e.prominence = 32; }) ==
          with([](LoopEvidence& e) { e.prominence = 99; }));
    CHECK(with([](LoopEvidence& e) { e.compactness = 0; }) ==
          with([](LoopEvidence& e) { e.compactness = 0.0625; }));
  }
  CHECK(probability_of(0) == 0.5);
  CHECK(probability_of(2) + probability_of(-2) == Approx(1));
}

TEST_CASE("a hole is measured for prominence if that could make it probable") {
  LoopEvidence evidence{.surface = 0.9, .sampling_gap = 0.6, .width = 2, .compactness = 0.1};
  CHECK(log_odds(evidence) < 0);
  CHECK(could_be_probable(evidence));
  evidence.surface = 0.3;
  CHECK_FALSE(could_be_probable(evidence));
}

}  // namespace
}  // namespace lacuna
