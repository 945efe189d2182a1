// SPDX-License-Identifier: Apache-2.0
// How sure a loop is: what its evidence adds, and how empty its lid is.
#include "engine/loops/rate_loops.hpp"

#include "engine/loops/confidence.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>

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
    for (double x = -radius; x <= radius; x += step) {
      if (std::hypot(x, y) <= radius) cloud.positions.emplace_back(29.5 + x, 29.5 + y, height);
    }
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

TEST_CASE("a hole is empty, and sparse points all over it make it less so and unsure") {
  const LoopMeasures empty = hole_of(punched_plane());
  CHECK(empty.track.evidence.emptiness > 0.999);
  CHECK(empty.track.evidence.width == Approx(kRadius).margin(1.5));
  CHECK(empty.track.evidence.roundness == Approx(1).margin(0.1));
  CHECK(empty.track.confidence > 0.95);
  const LoopMeasures sparse = hole_of(with_patch(punched_plane(), kRadius, 3)),
                     sparser = hole_of(with_patch(punched_plane(), kRadius, 4));
  CHECK(sparse.track.evidence.emptiness < sparser.track.evidence.emptiness);
  CHECK(sparser.track.evidence.emptiness < 0.7);
  CHECK(sparse.track.confidence < 0.5);
  CHECK(sparser.track.confidence < empty.track.confidence);
}

TEST_CASE("an island as dense as the surface leaves a hole likely, and a small one leaves it sure") {
  CHECK(hole_of(with_patch(punched_plane(), 5, 1)).track.confidence > 0.5);
  CHECK(hole_of(with_patch(punched_plane(), 3, 1)).track.confidence > 0.9);
}

TEST_CASE("what lies far before or behind a hole leaves it empty") {
  const LoopMeasures hole = hole_of(with_patch(punched_plane(), 8, 1, 12));
  CHECK(hole.track.evidence.emptiness > 0.999);
}

TEST_CASE("the lid follows its rim: a hole in a cylinder is empty, and points on the cylinder fill it") {
  const auto bent = [](Cloud cloud) {
    for (Eigen::Vector3d& p : cloud.positions)
      p = {25 * std::sin((p.x() - 29.5) / 25), p.y(), 25 * std::cos((p.x() - 29.5) / 25)};
    return cloud;
  };
  CHECK(hole_of(bent(punched_plane())).track.evidence.emptiness > 0.99);
  CHECK(hole_of(bent(with_patch(punched_plane(), kRadius, 3))).track.evidence.emptiness < 0.6);
}

TEST_CASE("outer curves have no lid") {
  for (const ReportedLoop& loop : run_engine(punched_plane(), {}).loops) {
    if (loop.measures.kind == LoopKind::kOuter) CHECK(loop.measures.track.evidence.emptiness == 1);
  }
}

TEST_CASE("log-odds rise with each evidence of a hole, and fall with gaps of the sampling") {
  const LoopEvidence plain{.clearness = 0.6,
                           .surface = 0.8,
                           .sampling_gap = 0.55,
                           .width = 4,
                           .roundness = 0.5,
                           .emptiness = 0.75};
  const auto with = [&](auto change) {
    LoopEvidence changed = plain;
    change(changed);
    return log_odds(changed);
  };
  const double before = log_odds(plain);
  CHECK(with([](LoopEvidence& e) { e.clearness = 0.65; }) > before);
  CHECK(with([](LoopEvidence& e) { e.surface = 0.9; }) > before);
  CHECK(with([](LoopEvidence& e) { e.emptiness = 0.8; }) > before);
  CHECK(with([](LoopEvidence& e) { e.roundness = 0.9; }) > before);
  CHECK(with([](LoopEvidence& e) { e.width = 5; }) > before);
  CHECK(with([](LoopEvidence& e) { e.persistence = 1; }) > before);
  CHECK(with([](LoopEvidence& e) { e.sampling_gap = 0.6; }) < before);
  // Beyond these, a number says nothing more.
  CHECK(with([](LoopEvidence& e) { e.clearness = 0.7; }) == with([](LoopEvidence& e) { e.clearness = 1; }));
  CHECK(with([](LoopEvidence& e) { e.emptiness = 0.8; }) == with([](LoopEvidence& e) { e.emptiness = 1; }));
  CHECK(with([](LoopEvidence& e) { e.width = 8; }) == with([](LoopEvidence& e) { e.width = 800; }));
  CHECK(with([](LoopEvidence& e) { e.width = 0.5; }) == with([](LoopEvidence& e) { e.width = 0; }));
  CHECK(with([](LoopEvidence& e) { e.persistence = 2; }) == with([](LoopEvidence& e) { e.persistence = 9; }));
  CHECK(probability_of(0) == 0.5);
  CHECK(probability_of(2) + probability_of(-2) == Approx(1));
}

}  // namespace
}  // namespace lacuna
