// SPDX-License-Identifier: Apache-2.0
// Which loops stand, of drawn ones at several levels, and of scans.
#include "engine/track/track_loops.hpp"

#include "engine/track/confidence.hpp"
#include "engine/track/near_loops.hpp"
#include "engine/track/track_all.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/scratch_folder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

struct DrawnLoop {
  Eigen::Vector3d middle;
  double radius;
  LoopEvidence evidence = sure();

  static LoopEvidence sure(bool is_coarse = false) {
    return {.clearness = 0.9, .surface = 0.9, .spacing = 1, .sampling_gap = 0.55, .is_coarse = is_coarse};
  }
  static LoopEvidence unsure() {
    return {.clearness = 0.6, .surface = 0.5, .spacing = 1, .sampling_gap = 0.6};
  }
};

class Drawn {
 public:
  explicit Drawn(Config given = {}) : config_(std::move(given)), job_(config_, folder_.path(), quiet_) {}

  // A level of circles, of points one edge apart.
  void add(double edge, const std::vector<DrawnLoop>& loops) {
    LevelLoops level{
        .edge = edge, .cell_edge = edge > 0 ? edge : 1, .points = 1000, .loops = Loops(job_.file("drawn"))};
    for (const DrawnLoop& loop : loops) {
      const int count = std::max(8, static_cast<int>(2 * std::numbers::pi * loop.radius / level.cell_edge));
      level.loops.add(static_cast<std::uint64_t>(count), loop.evidence, [&](std::uint64_t i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / count;
        const Eigen::Vector3d p =
            loop.middle + loop.radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
        return StoredLoopPoint{{p.x(), p.y(), p.z(), PointId{next_id_ + i}}, {0, 0, 0}, 0.5f};
      });
      next_id_ += static_cast<std::uint64_t>(count);
    }
    levels_.push_back(std::move(level));
  }

  std::vector<NearLoops> near() const { return near_loops(levels_, job_); }
  std::vector<TrackedLoop> track_all() { return lacuna::track_all(levels_, near(), job_); }
  TrackedLoops track() { return track_loops(std::move(levels_), job_); }

 private:
  test::ScratchFolder folder_;
  Config config_;
  NoProgress quiet_;
  Job job_;
  std::vector<LevelLoops> levels_;
  std::uint64_t next_id_ = 0;
};

TEST_CASE("a circle at two levels is the same hole, one beside it is another") {
  Drawn drawn;
  drawn.add(0, {{{0, 0, 0}, 20}, {{100, 0, 0}, 20}});
  drawn.add(2, {{{0.5, 0, 0}, 20.5}});
  const std::vector<NearLoops> near = drawn.near();
  REQUIRE(near.size() == 1);
  CHECK(near[0].a == 0);
  CHECK(near[0].b == 2);
  CHECK(near[0].of_a == 1);
  CHECK(near[0].of_b == 1);
}

TEST_CASE("of two loops that share an arc, the shares say how much of each is near the other") {
  Drawn drawn;
  drawn.add(0, {{{0, 0, 0}, 20}, {{0, 8, 0}, 12}});  // they touch at the top
  const std::vector<NearLoops> near = drawn.near();
  for (const NearLoops& pair : near) CHECK(pair.of_a < 0.5f);
  Drawn apart;
  apart.add(1, {{{0, 0, 0}, 20}});
  apart.add(1.4, {});
  apart.add(2, {});
  apart.add(2.8, {{{0, 0, 0}, 20}});  // three levels up: not compared
  CHECK(apart.near().empty());
}

TEST_CASE(
    "a hole is reported once, by its finest sure loop, and lasts to its last level, one of which it may "
    "miss") {
  Drawn drawn;
  drawn.add(0, {{{0, 0, 0}, 20}});
  drawn.add(2, {{{0, 0, 0}, 20}});
  drawn.add(2.83, {});
  drawn.add(4, {{{0, 0, 0}, 20}});
  const TrackedLoops tracked = drawn.track();
  REQUIRE(tracked.loops.size() == 1);
  CHECK(tracked.loops.count(0) == 125);  // one apart
  CHECK(tracked.tracks[0].first_scale == 0);
  CHECK(tracked.tracks[0].last_scale == 4);
  CHECK(tracked.tracks[0].persistence == 2);
  CHECK(tracked.tracks[0].confidence > 0.9);
}

TEST_CASE("every loop of every level has its own surface, and the best and the last level of its track") {
  Drawn drawn;
  drawn.add(0, {{{0, 0, 0}, 20, DrawnLoop::unsure()}, {{100, 0, 0}, 20, DrawnLoop::unsure()}});
  drawn.add(2, {{{0, 0, 0}, 20}});
  const std::vector<TrackedLoop> loops = drawn.track_all();
  REQUIRE(loops.size() == 3);
  const auto& [fine, other, coarse] = std::tie(loops[0], loops[1], loops[2]);
  CHECK(fine.evidence.surface == 0.5);
  CHECK(fine.evidence.best == Approx(0.9 * 0.9));
  CHECK(fine.evidence.persistence == 1);
  CHECK(fine.evidence.is_first_level);
  CHECK(fine.last == 1);
  CHECK(other.evidence.best == Approx(0.6 * 0.5));
  CHECK(other.evidence.persistence == 0);
  CHECK(other.last == 0);
  CHECK(coarse.evidence.surface == 0.9);
  CHECK(coarse.evidence.best == fine.evidence.best);
  CHECK(coarse.first == 0);
  CHECK(coarse.log_odds == log_odds(coarse.evidence));
}

TEST_CASE("a coarse loop stands where the fine ones at its place are unsure") {
  Drawn drawn;
  drawn.add(0, {{{0, 0, 0}, 20, DrawnLoop::unsure()}});
  drawn.add(2, {{{0, 0, 0}, 20}});
  const TrackedLoops tracked = drawn.track();
  REQUIRE(tracked.loops.size() == 1);
  CHECK(tracked.loops.count(0) < 100);
  CHECK(tracked.tracks[0].first_scale == 0);
  CHECK(tracked.tracks[0].last_scale == 2);
}

TEST_CASE("the best level of a track speaks for all of its loops") {
  Config all;
  all.selection.min_confidence = 0;
  Drawn alone(all), tracked(all);
  DrawnLoop dim{{0, 0, 0}, 20};
  dim.evidence.clearness = 0.7;
  alone.add(1, {dim});
  tracked.add(1, {dim});
  tracked.add(1.41, {{{0, 0, 0}, 20}});
  const TrackedLoops a = alone.track(), b = tracked.track();
  REQUIRE(a.loops.size() == 1);
  REQUIRE(b.loops.size() == 1);
  CHECK(a.loops.count(0) == b.loops.count(0));
  CHECK(b.tracks[0].confidence > a.tracks[0].confidence);
}

TEST_CASE("of a fine and a coarse bound at one level, the fine loop stands where both are sure") {
  Drawn drawn;
  drawn.add(0, {{{0, 0, 0}, 20, DrawnLoop::sure(true)}, {{0, 0, 0}, 20.4}});
  const TrackedLoops tracked = drawn.track();
  REQUIRE(tracked.loops.size() == 1);
  CHECK(tracked.loops.count(0) == 128);
}

TEST_CASE("log-odds rise with surface, persistence and roundness, and fall with gaps of the sampling") {
  const TrackEvidence plain{.clearness = 0.6,
                            .surface = 0.8,
                            .sampling_gap = 0.55,
                            .width = 5,
                            .roundness = 0.5,
                            .best = 0.6,
                            .persistence = 0.5,
                            .is_first_level = true};
  const auto with = [&](auto change) {
    TrackEvidence changed = plain;
    change(changed);
    return log_odds(changed);
  };
  const double before = log_odds(plain);
  CHECK(with([](TrackEvidence& e) { e.best = 0.7; }) > before);
  CHECK(with([](TrackEvidence& e) { e.persistence = 1.5; }) > before);
  CHECK(with([](TrackEvidence& e) { e.persistence = 2; }) ==
        with([](TrackEvidence& e) { e.persistence = 9; }));
  CHECK(with([](TrackEvidence& e) { e.roundness = 0.9; }) > before);
  CHECK(with([](TrackEvidence& e) { e.sampling_gap = 0.7; }) < before);
  // Even sampling at the first level is enough.
  const auto even = [](TrackEvidence& e) {
    e.surface = 0.85;
    e.clearness = 0.7;
    e.persistence = 0;
    e.sampling_gap = 0.7;
  };
  CHECK(with(even) == Approx(25 * 0.05));
  CHECK(with([&](TrackEvidence& e) {
          even(e);
          e.is_first_level = false;
        }) < 0);
  CHECK(with([&](TrackEvidence& e) {
          even(e);
          e.width = 9;  // it would persist
        }) < 0);
  CHECK(probability_of(0) == 0.5);
  CHECK(probability_of(2) + probability_of(-2) == Approx(1));
}

TEST_CASE("a circle is round, a wide river half round, and a slit of the sampling is not") {
  const double pi = std::numbers::pi;
  CHECK(roundness(2 * pi * 5, pi * 25, 5) == Approx(1));
  CHECK(roundness(2000, 1000 * 16, 16) == 0.5);
  CHECK(roundness(2000, 1000 * 4, 4) == Approx(0.25));
  CHECK(roundness(2000, 1000 * 0.5, 0.5) == Approx(1. / 32));
}

TEST_CASE("a higher --min-confidence leaves loops out, and changes none") {
  std::size_t left_out = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Cloud cloud = random_cloud(4'000 + seed);
    std::vector<std::vector<PointId>> before;
    for (const double least : {0.0, 0.3, 0.75, 0.95}) {
      INFO("seed " << seed << ", " << least);
      Config config;
      config.selection.min_confidence = least;
      const std::vector<std::vector<PointId>> now = run_engine(cloud, config).loop_ids();
      if (least > 0) {
        CHECK(std::includes(before.begin(), before.end(), now.begin(), now.end()));
        left_out += before.size() - now.size();
      }
      before = now;
    }
  }
  CHECK(left_out > 20);
}

// Sweeps with points one apart along them and six apart across; two of them are interrupted.
TEST_CASE(
    "a hole in a scan of lines is found at the level at which the lines become a surface, and no gap between "
    "them") {
  Cloud cloud;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 360; ++x) cloud.positions.emplace_back(x, 6 * y, 0);
  }
  cloud = cloud.punched({180, 180}, 40).jittered(0.3, 1).noisy(0.2, 2);
  const Detected detected = run_engine(cloud, {});
  CHECK(detected.summary.resolution == 0);
  REQUIRE(detected.summary.levels.size() > 4);
  std::vector<ReportedLoop> holes;
  for (const ReportedLoop& loop : detected.loops) {
    if (loop.measures.kind == LoopKind::kHole) holes.push_back(loop);
  }
  REQUIRE(holes.size() == 1);
  CHECK(holes[0].measures.diameter == Approx(80).margin(15));
  CHECK(holes[0].measures.track.last_scale >= 8);
  Config every_point;
  every_point.scale.every_point = true;
  CHECK(run_engine(cloud, every_point).summary.levels.size() == 1);
}

}  // namespace
}  // namespace lacuna
