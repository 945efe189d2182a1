// The engine against what another program made of real scans: ../shared/golden.
#include "tests/support/golden.hpp"

#include "engine/stages/evaluate.hpp"
#include "engine/stages/neighbourhoods.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/tile.hpp"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

GoldenLoops loops_of(const Detected& detected) {
  GoldenLoops loops;
  for (const ReportedLoop& loop : detected.loops) {
    loops.emplace_back();
    for (const LoopPoint& p : loop.points) loops.back().push_back(static_cast<std::int64_t>(value(p.id)));
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

TEST_CASE("the engine gives the golden probabilities, coherence and loops, in tiles of 3,000 points") {
  const auto shared = shared_folder();
  if (!shared) {
    WARN("no shared folder: skipped");
    return;
  }
  for (GoldenSetting& setting : golden_settings()) {
    INFO(setting.name);
    const std::vector<GoldenPoint> golden = read_golden_points(*shared, setting);
    setting.config.run.tile_points = 3000;
    const Detected detected = run_engine(read_cloud(*shared / setting.cloud), setting.config);
    REQUIRE(detected.points.size() == golden.size());
    double largest_error = 0;
    std::size_t wrong_coherence = 0;
    for (std::size_t i = 0; i < golden.size(); ++i) {
      const PointResult& p = detected.points[i];
      const GoldenPoint& g = golden[i];
      for (const double error :
           {p.angle - g.angle, p.halfdisc - g.halfdisc, p.shape - g.shape, p.probability - g.probability}) {
        largest_error = std::max(largest_error, std::abs(error));
      }
      wrong_coherence += (p.coherent != 0) != (g.coherent != 0);
    }
    CHECK(largest_error < 1e-6);
    CHECK(wrong_coherence == 0);
    CHECK(detected.summary.tiles > 1);
    CHECK(loops_of(detected) == read_golden_loops(*shared, setting));
  }
}

TEST_CASE("the stages give the golden neighbour counts, mean distances and gap neighbours") {
  const auto shared = shared_folder();
  if (!shared) {
    WARN("no shared folder: skipped");
    return;
  }
  for (const GoldenSetting& setting : golden_settings()) {
    INFO(setting.name);
    const std::vector<GoldenPoint> golden = read_golden_points(*shared, setting);
    const Cloud cloud = read_cloud(*shared / setting.cloud);
    const TilePoints points = whole_tile(cloud);
    const Config& config = setting.config;
    const Rows rows = find_neighbourhoods(points, static_cast<std::size_t>(config.neighbourhood.k),
                                          config.neighbourhood.eps);
    const std::vector<Evaluation> evaluations =
        evaluate(points, rows, owned_normals(cloud, points), config.normals, config.criteria);
    const auto id_of = [&](LocalIndex i) {
      return i == kNoIndex ? std::int64_t{-1} : static_cast<std::int64_t>(value(points.ids[i]));
    };
    std::size_t wrong_count = 0, wrong_distance = 0, wrong_gap = 0;
    for (LocalIndex i = 0; i < points.owned; ++i) {
      const GoldenPoint& g = golden[value(points.ids[i])];
      wrong_count += static_cast<std::int64_t>(rows[i].size()) != g.neighbours;
      wrong_distance += std::abs(evaluations[i].mean_distance - g.mean_distance) > 1e-12 * g.mean_distance;
      wrong_gap += id_of(evaluations[i].gap_near) != g.gap_near || id_of(evaluations[i].gap_far) != g.gap_far;
    }
    CHECK(wrong_count == 0);
    CHECK(wrong_distance == 0);
    CHECK(wrong_gap == 0);
  }
}

TEST_CASE("the engine finds the paper's figures: the bunny's five holes, the range map's rim of 844 points") {
  const auto shared = shared_folder();
  if (!shared) {
    WARN("no shared folder: skipped");
    return;
  }
  const Detected bunny = run_engine(read_cloud(*shared / "data/bun_zipper.ply"), {});
  CHECK(bunny.summary.e == 14);
  REQUIRE(bunny.loops.size() == 5);
  for (const ReportedLoop& loop : bunny.loops) CHECK(loop.measures.kind == LoopKind::kHole);

  Config config;  // figure 15
  config.spanning.e = 500;
  const Detected range_map = run_engine(read_cloud(*shared / "data/bun000.ply"), config);
  REQUIRE(range_map.loops.size() == 1);
  CHECK(range_map.loops[0].points.size() == 844);
  CHECK(range_map.loops[0].measures.kind == LoopKind::kRim);
}

}  // namespace
}  // namespace lacuna
