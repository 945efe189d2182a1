// SPDX-License-Identifier: Apache-2.0
// The engine against golden results: of synthetic clouds by the plain reference (tests/data), and of real
// scans by another program (../shared/golden).
#include "tests/support/golden.hpp"

#include "engine/evaluate/evaluate.hpp"
#include "engine/neighbours/neighbourhoods.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/made_golden.hpp"
#include "tests/support/tile.hpp"

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

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

TEST_CASE("the golden results of synthetic clouds are those of the plain reference, and not empty") {
  for (const GoldenCase& golden : golden_cases()) {
    INFO(golden.name());
    const GoldenOutcome expected = read_golden_outcome(golden);
    const GoldenOutcome found = plain_outcome(read_golden_cloud(golden.cloud), golden.config);
    CHECK(!expected.loops.empty());
    CHECK(found.points == expected.points);
    CHECK(found.loops == expected.loops);
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
    std::vector<GoldenPoint> found = golden;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const PointResult& p = detected.points[i];
      found[i].angle = p.criteria[0];
      found[i].halfdisc = p.criteria[1];
      found[i].shape = p.criteria[2];
      found[i].probability = p.probability;
      found[i].coherent = p.coherent;
    }
    check_golden(found, golden);
    CHECK(detected.summary.tiles > 1);
    CHECK(in_golden_form(detected.loop_ids()) == read_golden_loops(*shared, setting));
  }
}

TEST_CASE("the stages give the golden neighbour counts, mean distances and gap neighbours") {
  const auto shared = shared_folder();
  if (!shared) return;
  for (const GoldenSetting& setting : golden_settings()) {
    INFO(setting.name);
    const std::vector<GoldenPoint> golden = read_golden_points(*shared, setting);
    const Cloud cloud = read_cloud(*shared / setting.cloud);
    const TilePoints points = whole_tile(cloud);
    const Config& config = setting.config;
    const Neighbourhoods rows = find_neighbourhoods(points, static_cast<std::size_t>(config.neighbourhood.k),
                                                    config.neighbourhood.eps);
    const std::vector<Evaluation> evaluations =
        evaluate(points, rows, owned_normals(cloud, points), config.normals, config.criteria);
    const auto id_of = [&](LocalIndex i) {
      return i == kNoIndex ? std::int64_t{-1} : static_cast<std::int64_t>(value(points.ids[i]));
    };
    std::vector<GoldenPoint> found = golden;
    for (LocalIndex i = 0; i < points.owned; ++i) {
      const Evaluation& e = evaluations[i];
      GoldenPoint& p = found[value(points.ids[i])];
      p.neighbours = static_cast<std::int64_t>(rows[i].size());
      p.mean_distance = e.mean_distance;
      p.gap_near = id_of(e.gap_near);
      p.gap_far = id_of(e.gap_far);
    }
    check_golden(found, golden);
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
