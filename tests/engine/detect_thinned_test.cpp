// SPDX-License-Identifier: Apache-2.0
// Runs at a resolution: the method on the representatives, with ids and results of the whole input.
#include "tests/support/detected.hpp"
#include "tests/support/thinned.hpp"

namespace lacuna {
namespace {

Config at_resolution(double resolution) {
  Config config;
  config.scale.resolution = resolution;
  return config;
}

// A dense sheet with two holes, far from the origin.
Cloud sheet() {
  return plane(150)
      .punched({40, 50}, 12)
      .punched({100, 90}, 18)
      .jittered(0.5, 1)
      .noisy(0.1, 2)
      .translated({500'000, 5'400'000, 300});
}

bool same(const PointResult& a, const PointResult& b) {
  return a.probability == b.probability && a.criteria == b.criteria && a.boundary == b.boundary &&
         a.coherent == b.coherent && a.loop == b.loop && a.normal == b.normal;
}

TEST_CASE("a run at a resolution finds the loops of the representatives alone, by the ids of the input") {
  const Cloud cloud = sheet().with_unusable(50, 3);
  const double resolution = 2.5;
  const Detected thinned = run_engine(cloud, at_resolution(resolution));
  const Counts& counts = thinned.summary.counts;
  CHECK(thinned.summary.resolution == resolution);
  CHECK(counts.points == cloud.size());
  CHECK(counts.dropped == 50);
  CHECK(counts.duplicates == 0);
  REQUIRE(thinned.loops.size() == 3);

  // The representatives again, found plainly, as a scan of their own.
  const std::map<CellKey, std::size_t> representatives = plainly_chosen(cloud, resolution);
  const std::vector<std::size_t> chosen = plainly_chosen_ids(cloud, resolution);
  CHECK(counts.thinned_out == cloud.size() - 50 - chosen.size());
  Cloud alone;
  for (const std::size_t i : chosen) alone.positions.push_back(cloud.positions[i]);
  const Detected plain = run_engine(alone, at_resolution(resolution));  // each is alone in its cell
  std::vector<std::vector<PointId>> expected = plain.loop_ids();
  for (auto& loop : expected) {
    for (PointId& id : loop) id = PointId{chosen[value(id)]};
  }
  CHECK(thinned.loop_ids() == expected);

  // Each point has the results of its representative, a dropped one none.
  REQUIRE(thinned.points.size() == cloud.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.positions[i].allFinite()) {
      wrong += !std::isnan(thinned.points[i].probability);
      continue;
    }
    const std::size_t id = representatives.at(cell_of(cloud.positions[i], resolution));
    const auto at = std::ranges::lower_bound(chosen, id) - chosen.begin();
    wrong += !same(thinned.points[i], plain.points[static_cast<std::size_t>(at)]);
  }
  CHECK(wrong == 0);
  for (const BoundaryPoint& b : thinned.boundary)
    CHECK(std::binary_search(chosen.begin(), chosen.end(), value(b.id)));
}

TEST_CASE("tiles, threads, memory and batches never show at a resolution") {
  const Cloud cloud = sheet().with_duplicates(500, 1).with_unusable(20, 2);
  const std::string one_tile = run_engine(cloud, tiled(at_resolution(2), 1'000'000, 1)).bytes();
  for (const std::int64_t tile_points : {50, 500, 5'000}) {
    for (const std::int64_t threads : {1, 4})
      CHECK(run_engine(cloud, tiled(at_resolution(2), tile_points, threads)).bytes() == one_tile);
  }
  Config limited = at_resolution(2);
  limited.run.memory_limit = std::uint64_t{64} << 20;
  CHECK(run_engine(cloud, limited).bytes() == one_tile);
}

TEST_CASE("min_hole sets a fifth of it as the first edge, and leaves smaller loops out") {
  Config config;
  config.scale.min_hole = 30;
  CHECK(first_edge(config.scale) == 6);
  CHECK(with_min_hole(config).selection.min_diameter == 30);
  config.scale.resolution = 2;
  config.selection.min_diameter = 1;
  CHECK(first_edge(config.scale) == 2);
  CHECK(with_min_hole(config).selection.min_diameter == 1);
  CHECK(first_edge({}) == 0);
  CHECK(first_edge({.min_hole = 30, .every_point = true}) == 0);

  // Holes 24 and 36 across.
  config = {};
  config.scale.min_hole = 30;
  const Detected detected = run_engine(sheet(), config);
  REQUIRE(detected.loops.size() == 2);
  CHECK(detected.loops[0].measures.diameter > 100);  // the outer edge
  CHECK(detected.loops[1].measures.diameter > 30);
}

TEST_CASE("a resolution as large as the scan is an error that names its size") {
  Config config;
  config.scale.min_hole = 1000;
  const auto error = [&] { return test::error_of([&] { run_engine(sheet(), config); }); };
  CHECK_THAT(error(), StartsWith("a resolution of 200, for holes of 1000, leaves ") &&
                          Contains("the scan's size is 1") && EndsWith("allowed: a smaller --min-hole"));
  config = at_resolution(300);
  CHECK_THAT(error(),
             StartsWith("a resolution of 300 leaves ") && EndsWith("allowed: a smaller --resolution"));
  config = at_resolution(20);
  CHECK(error().empty());
}

}  // namespace
}  // namespace lacuna
