// SPDX-License-Identifier: Apache-2.0
// The engine against golden results: of synthetic clouds by the plain reference (tests/data), and of real
// scans by another program (../shared/golden).
#include "tests/support/golden.hpp"

#include "tests/support/detected.hpp"
#include "tests/support/made_golden.hpp"

namespace lacuna {
namespace {

GoldenOutcome outcome_of(const Detected& detected) {
  GoldenOutcome outcome;
  for (const PointResult& p : detected.points) {
    outcome.points.push_back(
        {std::uint32_t(std::lround(p.probability * 0x1p24)), p.coherent != 0, p.boundary != 0});
  }
  outcome.loops = detected.loop_ids();
  std::sort(outcome.loops.begin(), outcome.loops.end());
  return outcome;
}

TEST_CASE("the engine gives the golden results of synthetic clouds, whatever the tiles") {
  for (const GoldenCase& golden : golden_cases()) {
    const Cloud cloud = read_golden_cloud(golden.cloud);
    const GoldenOutcome expected = read_golden_outcome(golden);
    REQUIRE(expected.points.size() == cloud.size());
    for (const std::int64_t tile_points : {20, 150, 100'000}) {
      INFO(golden.name() << ", " << tile_points << " points a tile");
      const GoldenOutcome found = outcome_of(run_engine(cloud, tiled(golden.config, tile_points)));
      REQUIRE(found.points.size() == expected.points.size());
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < found.points.size(); ++i) wrong += found.points[i] != expected.points[i];
      CHECK(wrong == 0);
      CHECK(found.loops == expected.loops);
    }
  }
}

TEST_CASE("the engine gives the golden probabilities, coherence and loops, in tiles of 3,000 points") {
  const auto shared = shared_folder();
  if (!shared) return;
  for (GoldenSetting& setting : golden_settings()) {
    INFO(setting.name);
    const std::vector<GoldenPoint> golden = read_golden_points(*shared, setting);
    setting.config.run.tile_points = 3000;
    const Detected detected = run_engine(read_cloud(*shared / setting.cloud), setting.config);
    REQUIRE(detected.points.size() == golden.size());
    std::size_t wrong = 0;
    double largest_error = 0;
    for (std::size_t i = 0; i < golden.size(); ++i) {
      const PointResult& p = detected.points[i];
      const GoldenPoint& g = golden[i];
      wrong += (p.coherent != 0) != g.coherent;
      for (const double error : {p.criteria[0] - g.angle, p.criteria[1] - g.halfdisc, p.criteria[2] - g.shape,
                                 p.probability - g.probability})
        largest_error = std::max(largest_error, std::abs(error));
    }
    CHECK(wrong == 0);
    CHECK(largest_error < 1e-6);
    CHECK(detected.summary.tiles > 1);
    CHECK(outcome_of(detected).loops == read_golden_loops(*shared, setting));
  }
}

TEST_CASE(
    "the engine finds the paper's figures: the bunny's five holes, the range map's outer curve of 844 "
    "points") {
  const auto shared = shared_folder();
  if (!shared) return;
  const Detected bunny = run_engine(read_cloud(*shared / "data/bun_zipper.ply"), with_paper_loops({}));
  CHECK(bunny.summary.e == 14);
  REQUIRE(bunny.loops.size() == 5);
  for (const ReportedLoop& loop : bunny.loops) CHECK(loop.measures.kind == LoopKind::kHole);

  Config config = with_paper_loops({});  // figure 15
  config.spanning.e = 500;
  const Detected range_map = run_engine(read_cloud(*shared / "data/bun000.ply"), config);
  REQUIRE(range_map.loops.size() == 1);
  CHECK(range_map.loops[0].points.size() == 844);
  CHECK(range_map.loops[0].measures.kind == LoopKind::kOuter);
}

}  // namespace
}  // namespace lacuna
