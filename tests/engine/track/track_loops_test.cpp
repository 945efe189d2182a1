// SPDX-License-Identifier: Apache-2.0
// How sure a loop is: what its evidence adds, and how far it stands out of the gaps around it. Then which
// loops stand, of drawn ones at several levels, and of scans.
#include "engine/track/track_loops.hpp"

#include "engine/loops/confidence.hpp"
#include "engine/loops/rate_loops.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

// ---- How sure a loop is

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

// What lies over a flat round curve about 0 0 0 and beyond it, where its surface is within.
BeyondCurve beyond(const Cloud& cloud, double radius = 10) {
  std::vector<LoopPoint> loop;
  const int count = static_cast<int>(2 * std::numbers::pi * radius);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const Eigen::Vector3d p(radius * std::cos(angle), radius * std::sin(angle), 0);
    const Eigen::Vector3f inward = -p.normalized().cast<float>();
    loop.push_back({{p.x(), p.y(), p.z()}, {inward.x(), inward.y(), inward.z()}, 0.5f});
  }
  const TiledScan scan(cloud, tiled({}, 4));
  Scratch scratch(scan.job.spill.folder, 1 << 20);
  return beyond_curve(scan.store, loop, shape_of(loop, scratch), radius, 1, scratch);
}

Cloud disc(double radius, double height = 0, double least = 0) {
  Cloud cloud;
  for (double y = -radius; y <= radius; y += 0.5) {
    for (double x = -radius; x <= radius; x += 0.5)
      if (std::hypot(x, y) <= radius && std::hypot(x, y) >= least) cloud.positions.emplace_back(x, y, height);
  }
  return cloud;
}

Cloud both(Cloud a, const Cloud& b) {
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  return a;
}

TEST_CASE("the surface goes on beyond a curve where points lie outward of it, at its height") {
  const BeyondCurve edge = beyond(disc(10));
  CHECK(edge.goes_on == 0);
  CHECK(edge.layers == 0);
  CHECK(edge.volume == 0);
  CHECK(beyond(disc(16)).goes_on == 1);
  const BeyondCurve half = beyond(both(disc(10), plane(12).translated({0, -6, 0}).translated({5, 0, 0})));
  CHECK(half.goes_on > 0.1);
  CHECK(half.goes_on < 0.5);
  CHECK(beyond(both(disc(10), disc(20, 0, 15))).goes_on == 0);  // a ring too far away
}

TEST_CASE("beyond a slice of quantised depth is the next slice, a step higher") {
  const BeyondCurve slice = beyond(both(disc(10), disc(16, 1.5, 10)));
  CHECK(slice.goes_on == 0);
  CHECK(slice.layers == 1);
  CHECK(beyond(both(disc(10), disc(16, 4, 10))).layers == 0);
}

TEST_CASE("points over a curve that are far from its plane are a volume, as a crown is") {
  const BeyondCurve crown = beyond(both(disc(10), disc(9, 6)));
  CHECK(crown.volume == Approx(0.45).margin(0.05));
  CHECK(beyond(both(disc(10), disc(9, 1.5))).volume == 0);  // as thick as the points are apart
  CHECK(beyond(both(disc(10), disc(9, 12))).volume == 0);   // another surface
}

TEST_CASE("what lies beyond an outer curve is the same wherever the scan lies, and in any direction") {
  // A disc under a smaller one; a plane goes on along a quarter of its curve.
  const Cloud cloud = both(both(disc(12), disc(8, 5)), plane(12).translated({9, -6, 0})).noisy(0.05, 3);
  const auto widest = [](const Cloud& of) {
    Config config;
    config.selection.min_confidence = 0;
    LoopEvidence evidence;
    double most = 0;
    for (const ReportedLoop& loop : run_engine(of, config).loops) {
      if (loop.measures.kind != LoopKind::kOuter || loop.measures.area < most) continue;
      most = loop.measures.area;
      evidence = loop.measures.track.evidence;
    }
    CHECK(evidence.prominence == 0);
    return evidence.beyond;
  };
  const BeyondCurve before = widest(cloud),
                    after = widest(cloud.rotated({1, 2, 3}, 40).translated({456'000, 5'432'000, 100}));
  CHECK(before.volume > 0.1);
  CHECK(after.volume == Approx(before.volume).margin(0.02));
  CHECK(after.goes_on == Approx(before.goes_on).margin(0.05));
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
  CHECK(with([](LoopEvidence& e) { e.surface = 0.9; }) > before);
  if (kind == LoopKind::kOuter) {
    CHECK(with([](LoopEvidence& e) { e.beyond.goes_on = 0.5; }) < before);
    CHECK(with([](LoopEvidence& e) { e.beyond.layers = 0.5; }) < before);
    CHECK(with([](LoopEvidence& e) { e.beyond.volume = 0.5; }) < before);
    CHECK(with([](LoopEvidence& e) { e.alike = 1; }) < before);
    CHECK(with([](LoopEvidence& e) { e.alike = 255; }) == with([](LoopEvidence& e) { e.alike = 999; }));
  } else {
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

// ---- Which loops stand

struct DrawnLoop {
  Eigen::Vector3d middle;
  double radius;
  double surface = kSure;
  bool is_coarse = false;
  LoopKind kind = LoopKind::kHole;

  static constexpr double kSure = 0.95, kUnsure = 0.2;  // surface shares
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
                                  .middle = {loop.middle.x(), loop.middle.y(), loop.middle.z()},
                                  .radius = loop.radius,
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

  TrackedLoops track() { return track_loops(std::move(levels_), job_); }

 private:
  ScratchFolder folder_;
  Config config_;
  NoProgress quiet_;
  Job job_;
  std::vector<LevelLoops> levels_;
  std::uint64_t next_id_ = 0;
};

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

TEST_CASE("outer curves of half to twice the size are alike where they are near, and holes are not") {
  Drawn drawn;
  const auto outer = [](double x, double radius) {
    return DrawnLoop{.middle = {x, 0, 0}, .radius = radius, .kind = LoopKind::kOuter};
  };
  drawn.add(0, {outer(0, 10), outer(50, 18), outer(119, 6), outer(-121, 10), outer(-45, 22), outer(0, 4.5),
                DrawnLoop{.middle = {25, 0, 0}, .radius = 10}});
  std::map<double, std::uint64_t> alike;  // by x
  for (const LoopTrack& track : drawn.track().tracks)
    if (track.evidence.kind == LoopKind::kOuter) alike[track.evidence.middle[0]] += track.evidence.alike;
  // 10 at 0: 18 and 6, not the ones too far, too large and too small. 4.5 at 0: none.
  CHECK(alike == std::map<double, std::uint64_t>{{0, 2}, {50, 3}, {119, 0}, {-121, 0}, {-45, 1}});
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
