// SPDX-License-Identifier: Apache-2.0
// The whole engine against the method done plainly in memory, and against itself under every tiling.
#include "tests/support/detected.hpp"
#include "tests/support/reference.hpp"

namespace lacuna {
namespace {

bool near(float value, double expected) {
  return std::abs(value - expected) <= 1e-6;
}

// Points whose normal's side is decided by rounding alone. Symmetric clouds have edges of G whose weights 1 -
// |n . n'| differ by rounding noise. Such edges may disagree about the side. A normal may be at right angles
// to the next, or lie level where it should point up. Then any of the results is as good as another. All else
// has one result.
std::vector<bool> oriented_by_rounding(const reference::Detection& plain) {
  constexpr double kNoise = 1e-12;
  struct Pair {
    double weight, cosine;
    std::size_t a, b;
  };
  std::vector<Pair> pairs;
  for (const PointId id : plain.distinct) {
    const reference::Point& p = plain.points[value(id)];
    for (const PointId other : p.neighbours) {
      const reference::Point& q = plain.points[value(other)];
      if (!(id < other) || !p.oriented_normal || !q.oriented_normal) continue;
      const double cosine = p.oriented_normal->dot(*q.oriented_normal);
      pairs.push_back({1 - std::abs(cosine), cosine, value(id), value(other)});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.weight < b.weight; });

  std::vector<std::size_t> tree(plain.points.size());
  std::iota(tree.begin(), tree.end(), 0);
  const auto root = [&](std::size_t i) {
    while (tree[i] != i) i = tree[i] = tree[tree[i]];
    return i;
  };
  std::vector<bool> undecided(plain.points.size(), false);
  for (std::size_t i = 0; i < plain.points.size(); ++i) {
    const reference::Point& p = plain.points[i];
    undecided[i] = p.is_top && std::abs(p.normal->z()) <= kNoise;
  }
  for (std::size_t first = 0, last; first < pairs.size(); first = last) {
    last = first + 1;  // a group of edges as heavy as each other
    while (last < pairs.size() && pairs[last].weight - pairs[last - 1].weight <= kNoise) ++last;
    std::vector<const Pair*> contrary;
    for (std::size_t i = first; i < last; ++i)
      if (root(pairs[i].a) != root(pairs[i].b) && pairs[i].cosine <= kNoise) contrary.push_back(&pairs[i]);
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t a = root(pairs[i].a), b = root(pairs[i].b);
      if (a == b) continue;
      tree[b] = a;
      undecided[a] = undecided[a] || undecided[b];
    }
    for (const Pair* pair : contrary) undecided[root(pair->a)] = true;
  }
  for (std::size_t i = 0; i < undecided.size(); ++i) undecided[i] = undecided[root(i)];
  return undecided;
}

// Points whose criteria rounding alone decides. They have a neighbour exactly at the cone, or so near the
// normal line that noise makes its direction. Or a turn at a crease halves the angle probability exactly.
// Their probabilities are not compared.
std::vector<bool> judged_by_rounding(const reference::Detection& plain, const Cloud& cloud, double cone) {
  constexpr double kNoise = 1e-9;
  const double cos_cone = std::cos(cone * std::numbers::pi / 180);
  std::vector<bool> judged(plain.points.size(), false);
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const reference::Point& p = plain.points[i];
    judged[i] = p.turned_by_rounding;
    if (!p.normal) continue;
    const std::size_t at = value(p.representative);
    for (const PointId q : p.neighbours) {
      const Eigen::Vector3d offset = cloud.positions[value(q)] - cloud.positions[at];
      const double along = std::abs(p.normal->dot(offset)), length = offset.norm();
      const bool at_cone = cone > 0 && std::abs(along - cos_cone * length) <= kNoise * length;
      const bool at_line =
          cone == 0 && (offset - *p.normal * p.normal->dot(offset)).norm() <= kNoise * length;
      if (at_cone || at_line) judged[i] = true;
    }
  }
  return judged;
}

void check_equal(const Detected& engine, const reference::Detection& plain, std::vector<bool> judged = {}) {
  judged.resize(plain.points.size(), false);
  REQUIRE(engine.points.size() == plain.points.size());
  std::size_t wrong_probability = 0, wrong_coherence = 0, wrong_boundary = 0, wrong_normal = 0;
  const std::vector<bool> either_way = oriented_by_rounding(plain);
  for (std::size_t i = 0; i < plain.points.size(); ++i) {
    const reference::Point& p = plain.points[i];
    const PointResult& q = engine.points[i];
    if (p.dropped) {
      wrong_probability += !std::isnan(q.probability);
      continue;
    }
    wrong_probability += !judged[i] && (!near(q.probability, p.probability) || !near(q.criteria[0], p.angle));
    wrong_probability += !p.turned_by_rounding && !near(q.criteria[1], p.halfdisc);
    wrong_probability += !near(q.criteria[2], p.shape);
    wrong_coherence += (q.coherent != 0) != p.coherent;
    wrong_boundary += (q.boundary != 0) != p.boundary;
    if (p.oriented_normal) {
      const Eigen::Vector3f expected = p.oriented_normal->cast<float>(), normal(q.normal.data());
      const bool turned = either_way[value(p.representative)] && (expected + normal).norm() < 1e-4f;
      wrong_normal += !turned && !((expected - normal).norm() < 1e-4f);
    }
  }
  CHECK(wrong_probability == 0);
  CHECK(wrong_coherence == 0);
  CHECK(wrong_boundary == 0);
  CHECK(wrong_normal == 0);
  CHECK(engine.summary.mean_neighbours == plain.mean_neighbours);
  CHECK(engine.summary.mean_edge_length == Approx(plain.mean_edge_length).epsilon(1e-12));
  CHECK(engine.summary.e == plain.e);
  CHECK(engine.summary.counts.boundary_edges == plain.boundary_edges);
  CHECK(engine.loop_ids() == reference::in_report_order(plain.loops));
  REQUIRE(engine.loops.size() == plain.confidences.size());
  std::vector<double> confidences;
  for (const ReportedLoop& loop : engine.loops) confidences.push_back(loop.measures.track.confidence);
  std::vector<double> expected = plain.confidences;
  std::sort(confidences.begin(), confidences.end());
  std::sort(expected.begin(), expected.end());
  // Rounding decides on which side of a pixel's edge a point lies: one point more or less over a curve.
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(std::abs(confidences[i] - expected[i]) < 1e-3);
}

// The seed decides the cloud, every parameter and the tiling.
void check_seed(std::uint64_t seed) {
  const Cloud cloud = random_cloud(seed);
  Config config = random_config(seed, typical_spacing(cloud));
  config.normals.orient = seed % 3 == 0;
  INFO("seed " << seed << ", " << cloud.size() << " points");
  const reference::Detection plain = reference::detect(cloud.positions, cloud.normals, config);
  const std::int64_t tile_points = std::array<std::int64_t, 4>{1, 30, 300, 100'000}[seed % 4];
  check_equal(run_engine(cloud, tiled(config, tile_points)), plain,
              judged_by_rounding(plain, cloud, config.criteria.cone));
}

TEST_CASE("random clouds with random parameters give the results of the plain method under any tiling") {
  for (std::uint64_t seed = 1; seed <= draws(50); ++seed) check_seed(seed);
}

TEST_CASE("two thousand more random clouds give the results of the plain method", "[.slow]") {
  for (std::uint64_t seed = 51; seed <= 2250; ++seed) check_seed(seed);
}

TEST_CASE("clouds made to be hard give the results of the plain method with random parameters", "[.slow]") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Cloud cloud = hard_cloud(seed);
    Config config = random_config(seed, 0.5);
    config.neighbourhood.eps_fraction =
        0;  // of its outliers' distance: everyone would be everyone's neighbour
    INFO("seed " << seed);
    const std::int64_t tile_points = std::array<std::int64_t, 4>{20, 200, 1000, 100'000}[seed % 4];
    const reference::Detection plain = reference::detect(cloud.positions, cloud.normals, config);
    check_equal(run_engine(cloud, tiled(config, tile_points)), plain,
                judged_by_rounding(plain, cloud, config.criteria.cone));
  }
}

TEST_CASE("tiling and threads never show, on a cloud made to be hard") {
  const Cloud cloud = hard_cloud(3);
  Config config;
  config.normals.orient = true;
  const std::string one_tile = run_engine(cloud, tiled(config, 1'000'000, 1)).bytes();
  for (const std::int64_t tile_points : {1, 50, 500, 5'000}) {
    for (const std::int64_t threads : {1, 2, 8}) {
      if (tile_points == 1 && threads != 8) continue;  // the slowest
      INFO(tile_points << " points a tile, " << threads << " threads");
      CHECK(run_engine(cloud, tiled(config, tile_points, threads)).bytes() == one_tile);
    }
  }
  check_equal(run_engine(cloud, tiled(config, 500)), reference::detect(cloud.positions, {}, config));
}

// Thick with noise, nearly every point is a candidate: most of the graph is loops that reach over many tiles.
void check_tangles(std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const Cloud cloud = scattered(1500, seed).scaled(40).noisy(0.5, seed).shuffled(seed);
    Config config;
    config.spanning.e = 3 + static_cast<std::int64_t>(seed % 8);
    INFO("seed " << seed);
    const std::string one_tile = run_engine(cloud, tiled(config, 1'000'000, 1)).bytes();
    for (const std::int64_t tile_points : {1, 40, 300})
      CHECK(run_engine(cloud, tiled(config, tile_points)).bytes() == one_tile);
    if (seed % 4 == 1)
      check_equal(run_engine(cloud, tiled(config, 100)), reference::detect(cloud.positions, {}, config));
  }
}

TEST_CASE("tiling never shows in a tangle of short loops across many tiles") {
  check_tangles(1, draws(5));
}

TEST_CASE("tiling never shows in many more tangles of short loops across many tiles", "[.slow]") {
  check_tangles(6, 40);
}

// ---- Degenerate and difficult clouds -------------------------------------------------------------------

void check_against_plain(const Cloud& cloud, const Config& config = {}, std::int64_t tile_points = 300) {
  const reference::Detection plain = reference::detect(cloud.positions, cloud.normals, config);
  check_equal(run_engine(cloud, tiled(config, tile_points)), plain);
}

TEST_CASE("clouds of no, one, two, k and k + 1 points have the results of the plain method") {
  for (const int n : {0, 1, 2, 3, 15, 16, 17}) {
    INFO(n << " points");
    check_against_plain(scattered(n, 1));
    check_against_plain(scattered(n, 1), {}, 1);
    check_against_plain(line(n));
    check_against_plain(sphere(n));
  }
}

TEST_CASE("points all equal, on a line, on a plane or none of them finite give a result") {
  Config oriented;
  oriented.normals.orient = true;
  for (const Config& config : {Config{}, oriented}) {
    check_against_plain(coincident(1000).translated({1, 2, 3}), config);
    check_against_plain(line(500), config);
    check_against_plain(line(500).rotated({1, 2, 3}, 40), config);
    check_against_plain(plane(30), config);
    check_against_plain(plane(30).translated({0, 0, -1e-3}), config, 20);
    check_against_plain(Cloud{std::vector(50, Eigen::Vector3d::Constant(std::nan("")).eval()), {}}, config);
  }
}

TEST_CASE("thousands of coincident points are one point") {
  Cloud cloud = plane(30).jittered(0.2, 4);
  for (int i = 0; i < 5000; ++i) cloud.positions.push_back(cloud.positions[435]);
  check_against_plain(cloud.shuffled(1));
  check_against_plain(cloud.shuffled(1), {}, 10);
  CHECK(run_engine(cloud, {}).summary.counts.duplicates == 5000);
}

TEST_CASE("an eps ball larger than a tile, and one given as a fraction of the diagonal") {
  const Cloud cloud = plane(25).punched({12, 12}, 4).jittered(0.2, 4);
  Config wide, fraction, beyond;
  wide.neighbourhood.eps = 6;
  fraction.neighbourhood.eps_fraction = 0.1;
  beyond.neighbourhood.eps = 100;
  for (const std::int64_t tile_points : {1, 40, 10'000}) {
    check_against_plain(cloud, wide, tile_points);
    check_against_plain(cloud, fraction, tile_points);
  }
  check_against_plain(plane(14).jittered(0.2, 4), beyond, 20);
  CHECK(run_engine(plane(31), fraction).summary.eps == Approx(0.1 * 30 * std::sqrt(2)));
}

TEST_CASE("lone outliers at 1e9 and clusters far apart see the neighbours they have") {
  Cloud outliers = plane(25).jittered(0.2, 4);
  outliers.positions.push_back({1e9, 0, 0});
  outliers.positions.push_back({-3e9, 1e9, 7});
  outliers.positions.insert(outliers.positions.begin(), {0, 0, 1e9});
  const Cloud clusters =
      sphere(300).joined(sphere(10).translated({1e7, 0, 0})).joined(plane(20).translated({0, 1e8, 0}));
  for (const std::int64_t tile_points : {1, 60, 10'000}) {
    check_against_plain(outliers, {}, tile_points);
    check_against_plain(clusters, {}, tile_points);
  }
}

TEST_CASE("with k larger than the scan every point is every other's neighbour") {
  Config config;
  config.neighbourhood.k = 1000;
  const Cloud cloud = scattered(300, 5);
  for (const std::int64_t tile_points : {1, 30, 10'000}) check_against_plain(cloud, config, tile_points);
  CHECK(run_engine(cloud, config).summary.mean_neighbours == 299);
}

TEST_CASE("the smallest memory limit and eight threads change nothing") {
  const Cloud cloud =
      plane(120).punched({60, 60}, 9).jittered(0.25, 3).joined(hard_cloud(5).translated({300, 0, 0}));
  Config limited;
  limited.run.memory_limit = 64 << 20;
  const std::string expected = run_engine(cloud, tiled({}, 1'000'000, 1)).bytes();
  CHECK(run_engine(cloud, tiled(limited, 0, 8)).bytes() == expected);
  CHECK(run_engine(cloud, tiled(limited, 100, 8)).bytes() == expected);
  CHECK(run_engine(cloud, tiled(limited, 1'000'000, 1)).bytes() == expected);
}

TEST_CASE("distinct points too near or too far from each other are refused") {
  Cloud near = scattered(40, 1), far = scattered(40, 1);
  near.positions.push_back({1e-170, 0, 0});
  near.positions.push_back({2e-170, 0, 0});
  far.positions.push_back({1e160, 0, 0});
  for (const std::int64_t tile_points : {1, 10'000}) {
    CHECK_THROWS_AS(run_engine(near, tiled({}, tile_points)), Error);
    CHECK_THROWS_AS(run_engine(far, tiled({}, tile_points)), Error);
  }
}

// ---- Shapes ------------------------------------------------------------------------------------------

TEST_CASE("the engine finds no loop and no boundary point on a sphere") {
  const Detected detected = run_engine(sphere(3000), tiled({}, 200, 8));
  CHECK(detected.loops.empty());
  CHECK(detected.summary.counts.boundary_points == 0);
}

TEST_CASE("an open cylinder has two loops, one at each end") {
  const Detected detected = run_engine(open_cylinder(60, 30).noisy(0.03, 2), tiled({}, 200, 8));
  REQUIRE(detected.loops.size() == 2);
  std::vector<double> heights;
  for (const ReportedLoop& loop : detected.loops) {
    heights.push_back(loop.measures.centroid.z());
    CHECK(loop.measures.perimeter == Approx(60).epsilon(0.1));
  }
  std::sort(heights.begin(), heights.end());
  CHECK(heights[0] == Approx(0).margin(0.5));
  CHECK(heights[1] == Approx(29).margin(0.5));
}

TEST_CASE("a step of the density to a quarter has no loop along it, only the outer curve") {  // the paper's
                                                                                              // figure 11
  const int n = 60;
  Cloud cloud;
  Random random(11);
  for (const Eigen::Vector3d& p : density_step(n).positions) {
    const double jitter = p.x() < n / 2 ? 0.25 : 0.5;  // a quarter of the spacing
    cloud.positions.push_back(
        p + Eigen::Vector3d(random.uniform(-jitter, jitter), random.uniform(-jitter, jitter), 0));
  }
  for (const std::int64_t tile_points : {50, 10'000}) {
    const Detected detected = run_engine(cloud, tiled({}, tile_points));
    REQUIRE(detected.loops.size() == 1);
    CHECK(detected.loops[0].measures.kind == LoopKind::kOuter);
    for (const LoopPoint& p : detected.loops[0].points) {
      const double edge = std::min({p.x, p.y, n - 1 - p.x, n - 1 - p.y});
      if (edge > 3.5) FAIL_CHECK("point " << value(p.id) << " of the loop lies inside");
    }
  }
}

// ---- Invariance --------------------------------------------------------------------------------------

Cloud holed_cloud(std::uint64_t seed) {
  return plane(40)
      .punched({20, 20}, 5)
      .jittered(0.25, seed)
      .noisy(0.02, seed)
      .joined(sphere(800).scaled(6).noisy(0.01, seed).translated({70, 10, 0}));
}

// The lattices of the levels do not move with the scan. In exact lattices, places decide which triangles a
// loop has.
TEST_CASE(
    "a scan moved by a million has the same probabilities among all points to the last bit, and the same "
    "loops where there are no ties") {
  Config config = tiled({}, 300);
  config.scale.every_point = true;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Cloud cloud = holed_cloud(seed).joined(hard_cloud(seed).translated({0, 200, 0})).rounded(0x1p-20);
    Cloud usable;  // an unbounded outlier would lose its digits
    for (const Eigen::Vector3d& p : cloud.positions)
      if (p.allFinite() && p.norm() < 1e5) usable.positions.push_back(p);
    const Detected here = run_engine(usable, config);
    const Detected there = run_engine(usable.translated({1e6, -1e6, 1e6}), config);
    std::size_t different = 0;
    for (std::size_t i = 0; i < usable.size(); ++i) {
      const PointResult &a = here.points[i], &b = there.points[i];
      different += a.probability != b.probability || a.coherent != b.coherent;
    }
    CHECK(different == 0);
    const Cloud generic = holed_cloud(seed + 10);  // whose digits are rounded by the move
    CHECK(run_engine(generic.translated({1e6, 1e6, -1e6}), config).loop_ids() ==
          run_engine(generic, config).loop_ids());
  }
}

TEST_CASE("a power of two as the scale changes no loop") {
  const Cloud cloud = holed_cloud(4);
  const Detected here = run_engine(cloud, tiled({}, 300));
  for (const double factor : {0x1p-90, 0x1p-40, 0x1p-20, 0x1p30, 0x1p90}) {
    const Detected scaled = run_engine(cloud.scaled(factor), tiled({}, 300));
    CHECK(scaled.loop_ids() == here.loop_ids());
    REQUIRE(!here.loops.empty());
    CHECK(scaled.loops[0].measures.perimeter == factor * here.loops[0].measures.perimeter);
    CHECK(scaled.loops[0].measures.tiles == here.loops[0].measures.tiles);
  }
}

TEST_CASE("a turned scan has the same loops, where no ties are decided by rounding") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Cloud cloud = holed_cloud(seed);
    const std::vector<std::vector<PointId>> loops = run_engine(cloud, tiled({}, 300)).loop_ids();
    CHECK(loops.size() >= 2);
    for (const double degrees : {20.0, 90.0, 171.0})
      CHECK(run_engine(cloud.rotated({1, 2, -3}, degrees), tiled({}, 300)).loop_ids() == loops);
  }
}

// A hole does not count, nor do points in the air.
TEST_CASE("the sampled surface has the area of the shape, whatever its density") {
  const auto area = [](const Cloud& cloud) { return run_engine(cloud, tiled({}, 500)).summary.surface_area; };
  CHECK(area(sphere(8000)) == Approx(4 * std::numbers::pi).epsilon(0.02));
  CHECK(area(sphere(8000).scaled(100)) == Approx(4e4 * std::numbers::pi).epsilon(0.02));
  const Cloud whole = plane(100).jittered(0.25, 1);
  CHECK(area(whole) == Approx(1e4).epsilon(0.03));
  CHECK(area(whole) - area(whole.punched({50, 50}, 25)) == Approx(25 * 25 * std::numbers::pi).epsilon(0.06));
  CHECK(area(density_step(100).jittered(0.25, 1)) == Approx(1e4).epsilon(0.06));
  CHECK(area(whole.joined(whole.noisy(0.05, 2))) == Approx(1e4).epsilon(0.1));
  for (const double away : {1e3, 1e9}) {  // points far from all others have no surface
    Cloud outliers;
    for (int i = 1; i <= 20; ++i) outliers.positions.emplace_back(away * i, away * i * i / 7, -away * i);
    CHECK(area(whole.joined(outliers)) == Approx(1e4).epsilon(0.03));
  }
  Random random(5);
  Cloud floaters;
  for (int i = 0; i < 500; ++i)
    floaters.positions.emplace_back(random.uniform(0, 1e3), random.uniform(0, 1e3), random.uniform(0, 1e3));
  CHECK(area(whole.joined(floaters)) == Approx(1e4).epsilon(0.06));
  CHECK(area({}) == 0);
}

// Each column of points is one point then. On a plane of the lattice it would be two, above and below.
TEST_CASE("the frames of a grid that lie on each other have its hole, on any plane") {
  const Cloud frame = plane(40).punched({20, 20}, 6);
  for (const double height : {0.0, 1.0, 4.0, 0.3}) {
    CAPTURE(height);
    Cloud frames;
    Random random(7);
    for (int i = 0; i < 12; ++i) {
      Cloud one = frame.translated({0, 0, height});
      for (Eigen::Vector3d& p : one.positions) p.z() += random.uniform(-0.05, 0.05);
      frames = frames.joined(one);
    }
    CHECK(run_engine(frames, tiled({}, 2000)).loop_ids().size() == 2);
  }
}

std::vector<double> numbers_of(const LoopMeasures& m, const std::vector<ReportedLoop>& loops) {
  const LoopEvidence& e = m.track.evidence;
  std::vector<double> numbers = {m.kind == LoopKind::kHole ? 1.0 : 0.0,
                                 double(m.points),
                                 m.perimeter,
                                 m.area,
                                 m.own_area,
                                 m.diameter,
                                 m.planarity,
                                 m.mean_probability,
                                 double(m.tiles),
                                 m.track.confidence,
                                 m.track.first_scale,
                                 m.track.last_scale,
                                 e.clearness,
                                 e.surface,
                                 e.spacing,
                                 e.sampling_gap,
                                 e.width,
                                 e.compactness,
                                 e.prominence,
                                 e.persistence,
                                 e.beyond.goes_on,
                                 e.beyond.layers,
                                 e.beyond.volume,
                                 double(e.alike)};
  const Eigen::Vector3d parent =
      m.parent < 0 ? Eigen::Vector3d::Zero() : loops[static_cast<std::size_t>(m.parent)].measures.centroid;
  for (const Eigen::Vector3d& v : {m.centroid, m.normal, parent})
    numbers.insert(numbers.end(), v.begin(), v.end());
  return numbers;
}

// The numbers of each loop, by the places of its points.
using Numbers = std::map<std::vector<std::array<double, 3>>, std::vector<double>>;

Numbers loops_in(const Cloud& cloud) {
  Config config;
  config.selection.min_confidence = 0;
  const Detected detected = run_engine(cloud, tiled(config, 500));
  Numbers loops;
  for (const auto& [measures, points] : detected.loops) {
    std::vector<std::array<double, 3>> places;
    for (const LoopPoint& p : points) places.push_back({p.x, p.y, p.z});
    std::ranges::sort(places);
    loops[places] = numbers_of(measures, detected.loops);
  }
  return loops;
}

TEST_CASE("the order of the points changes neither loops nor any number of one") {
  const Cloud island = plane(8).translated({28.5, 27.5, 0});
  const Cloud holed = plane(50).punched({14, 16}, 5).punched({32, 31}, 10).joined(island);
  const Cloud cloud = holed.jittered(0.3, 1).noisy(0.05, 2).rotated({1, 2, 3}, 40);
  const auto loops = loops_in(cloud);
  CHECK(loops.size() >= 4);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto shuffled = loops_in(cloud.shuffled(seed));
    CHECK(shuffled.size() == loops.size());
    for (const auto& [places, numbers] : loops) {
      REQUIRE(shuffled.contains(places));
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        INFO("shuffled by " << seed << ", number " << i);
        CHECK(shuffled.at(places)[i] == Approx(numbers[i]).epsilon(1e-6).margin(1e-9));
      }
    }
  }
}

}  // namespace
}  // namespace lacuna
