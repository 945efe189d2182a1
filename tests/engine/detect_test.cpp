// The whole engine against the method done plainly in memory, and against itself under every tiling.
#include <algorithm>
#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/support/clouds.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/reference.hpp"

namespace lacuna {
namespace {

Config tiled(Config config, std::int64_t tile_points, std::int64_t threads = 2) {
  config.run.tile_points = tile_points;
  config.run.threads = threads;
  return config;
}

bool near(float value, double expected) { return std::abs(value - expected) <= 1e-6; }

std::vector<std::vector<PointId>> in_report_order(std::vector<std::vector<PointId>> loops) {
  std::sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) {
    if (a[0] != b[0]) return a[0] < b[0];
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return loops;
}

void check_equal(const Detected& engine, const reference::Detection& plain) {
  REQUIRE(engine.points.size() == plain.points.size());
  std::size_t wrong_probability = 0, wrong_coherence = 0, wrong_boundary = 0, wrong_normal = 0;
  for (std::size_t i = 0; i < plain.points.size(); ++i) {
    const reference::Point& p = plain.points[i];
    const PointResult& q = engine.points[i];
    if (p.dropped) {
      wrong_probability += !std::isnan(q.probability);
      continue;
    }
    wrong_probability += !near(q.probability, p.probability) || !near(q.angle, p.angle) ||
                         !near(q.halfdisc, p.halfdisc) || !near(q.shape, p.shape);
    wrong_coherence += (q.coherent != 0) != p.coherent;
    wrong_boundary += (q.boundary != 0) != p.boundary;
    if (p.oriented_normal) wrong_normal += !((p.oriented_normal->cast<float>() - q.normal).norm() < 1e-4f);
  }
  CHECK(wrong_probability == 0);
  CHECK(wrong_coherence == 0);
  CHECK(wrong_boundary == 0);
  CHECK(wrong_normal == 0);
  CHECK(engine.summary.mean_neighbours == plain.mean_neighbours);
  CHECK(engine.summary.mean_edge_length == Approx(plain.mean_edge_length).epsilon(1e-12));
  CHECK(engine.summary.e == plain.e);
  CHECK(engine.summary.counts.eligible_edges == plain.eligible.size());
  CHECK(engine.loop_ids() == in_report_order(plain.loops));
}

// The seed decides the cloud, every parameter and the tiling.
void check_seed(std::uint64_t seed) {
  const Cloud cloud = random_cloud(seed);
  Config config = random_config(seed, typical_spacing(cloud));
  config.normals.orient = seed % 3 == 0;
  INFO("seed " << seed << ", " << cloud.size() << " points");
  const reference::Detection plain = reference::detect(cloud.positions, cloud.normals, config);
  const std::int64_t tile_points = std::array<std::int64_t, 4>{1, 30, 300, 100'000}[seed % 4];
  check_equal(run_engine(cloud, tiled(config, tile_points)), plain);
}

}  // namespace

TEST_CASE("a punched plane has its hole and its rim, as in the plain method") {
  const Cloud cloud = plane(40).punched({20, 20}, 5).jittered(0.2, 7);
  const reference::Detection plain = reference::detect(cloud.positions, {}, Config{});
  const Detected engine = run_engine(cloud, tiled({}, 300));
  check_equal(engine, plain);
  REQUIRE(engine.loops.size() == 2);
  CHECK(engine.loops[0].measures.kind == LoopKind::kRim);
  CHECK(engine.loops[1].measures.kind == LoopKind::kHole);
}

TEST_CASE("random clouds with random parameters give the results of the plain method under any tiling") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) check_seed(seed);
}

TEST_CASE("two thousand more random clouds give the results of the plain method", "[.slow]") {
  for (std::uint64_t seed = 101; seed <= 2100; ++seed) check_seed(seed);
}

TEST_CASE("tiling and threads never show, on a cloud made to be hard") {
  const Cloud cloud = hard_cloud(3);
  Config config;
  config.normals.orient = true;
  const std::string one_tile = run_engine(cloud, tiled(config, 1'000'000, 1)).bytes();
  for (const std::int64_t tile_points : {1, 50, 500, 5'000}) {
    for (const std::int64_t threads : {1, 2, 8}) {
      INFO(tile_points << " points a tile, " << threads << " threads");
      CHECK(run_engine(cloud, tiled(config, tile_points, threads)).bytes() == one_tile);
    }
  }
  check_equal(run_engine(cloud, tiled(config, 500)), reference::detect(cloud.positions, {}, config));
}

}  // namespace lacuna
