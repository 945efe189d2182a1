// SPDX-License-Identifier: Apache-2.0
// Which loops stand, of drawn ones at several levels, and of scans.
#include "engine/track/track_loops.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/draws.hpp"

namespace lacuna {
namespace {

struct DrawnLoop {
  Eigen::Vector3d middle;
  double radius;
  double surface = kSure;
  bool is_coarse = false;
  LoopKind kind = LoopKind::kHole;

  static constexpr double kSure = 0.95, kUnsure = 0.35;  // surface shares
};

class Drawn {
 public:
  explicit Drawn(Config given = {}) : config_(std::move(given)), job_(config_, folder_.path(), quiet_) {}

  // A level of circles, of points one edge apart.
  void add(double edge, const std::vector<DrawnLoop>& loops) {
    LevelLoops level{.edge = edge,
                     .cell_edge = edge > 0 ? edge : 1,
                     .points = 1000,
                     .loops = Loops(job_.spill.file("drawn"))};
    for (const DrawnLoop& loop : loops) {
      const int count = std::max(8, static_cast<int>(2 * std::numbers::pi * loop.radius / level.cell_edge));
      const LoopEvidence evidence{.clearness = 0.7,
                                  .surface = loop.surface,
                                  .spacing = 1,
                                  .sampling_gap = 0.5,
                                  .is_coarse = loop.is_coarse,
                                  .kind = loop.kind,
                                  .width = 8,
                                  .compactness = 1 / (2 * std::numbers::pi),
                                  .prominence = 8};
      level.loops.add(static_cast<std::uint64_t>(count), evidence, [&](std::uint64_t i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / count;
        const Eigen::Vector3d p =
            loop.middle + loop.radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
        return LoopPoint{{p.x(), p.y(), p.z(), PointId{next_id_ + i}}, {0, 0, 0}, 0.5f};
      });
      next_id_ += static_cast<std::uint64_t>(count);
    }
    levels_.push_back(std::move(level));
  }

  std::vector<NearLoops> near() const { return near_loops(levels_, job_.spill, job_.workers); }
  TrackedLoops track() { return track_loops(std::move(levels_), job_); }

 private:
  ScratchFolder folder_;
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
  CHECK(tracked.tracks[0].evidence.persistence == 2);
  CHECK(tracked.tracks[0].confidence > 0.9);
}

TEST_CASE("a coarse loop stands where the fine ones at its place are unsure") {
  Drawn drawn;
  drawn.add(0, {{{0, 0, 0}, 20, DrawnLoop::kUnsure}});
  drawn.add(2, {{{0, 0, 0}, 20}});
  const TrackedLoops tracked = drawn.track();
  REQUIRE(tracked.loops.size() == 1);
  CHECK(tracked.loops.count(0) < 100);
  CHECK(tracked.tracks[0].first_scale == 0);
  CHECK(tracked.tracks[0].last_scale == 2);
}

TEST_CASE("of a fine and a coarse bound at one level, the fine loop stands where both are sure") {
  Drawn drawn;
  drawn.add(0, {{{0, 0, 0}, 20, DrawnLoop::kSure, true}, {{0, 0, 0}, 20.4}});
  const TrackedLoops tracked = drawn.track();
  REQUIRE(tracked.loops.size() == 1);
  CHECK(tracked.loops.count(0) == 128);
}

TEST_CASE("an opening and the outer curve around it stay two, though a coarse cell holds both") {
  const DrawnLoop opening{{0, 0, 0}, 20}, around{.middle = {0, 0, 0}, .radius = 26, .kind = LoopKind::kOuter};
  Drawn drawn;
  for (const double edge : {0., 2., 4.}) drawn.add(edge, {around, opening});
  CHECK(drawn.track().loops.size() == 2);
  Drawn coarse;  // the opening has no finer loop of its own
  for (const double edge : {0., 2.}) coarse.add(edge, {around});
  coarse.add(4, {around, opening});
  CHECK(coarse.track().loops.size() == 1);
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
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 360; ++x) cloud.positions.emplace_back(x, 6 * y, 0);
  cloud = cloud.punched({180, 180}, 40).jittered(0.3, 1).noisy(0.2, 2);
  const Detected detected = run_engine(cloud, {});
  CHECK(detected.summary.resolution == 0);
  REQUIRE(detected.summary.levels.size() > 4);
  std::vector<ReportedLoop> holes;
  for (const ReportedLoop& loop : detected.loops)
    if (loop.measures.kind == LoopKind::kHole) holes.push_back(loop);
  REQUIRE(holes.size() == 1);
  CHECK(holes[0].measures.diameter == Approx(80).margin(15));
  CHECK(holes[0].measures.track.last_scale >= 8);
  Config every_point;
  every_point.scale.every_point = true;
  CHECK(run_engine(cloud, every_point).summary.levels.size() == 1);
}

}  // namespace
}  // namespace lacuna
