// SPDX-License-Identifier: Apache-2.0
// The representatives of the cells of a lattice, their stores and levels, and runs of the method on them.
#include "engine/thin/thin.hpp"

#include "engine/thin/choose_points.hpp"
#include "engine/thin/level.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

// ---- Cells

TEST_CASE("cells are counted from the origin, and those at 0 reach a quarter of an edge below it") {
  const Lattice lattice(0.5);
  CHECK(lattice.place_of({0.1, 0.5, 1.7}).cell == Eigen::Vector3d(0, 1, 3));
  CHECK(lattice.place_of({-0.125, -0.126, -0.6}).cell == Eigen::Vector3d(0, -1, -2));
  CHECK(lattice.place_of({500'000.3, 5'400'000.1, 0}).cell == Eigen::Vector3d(1'000'000, 10'800'000, 0));
  CHECK(lattice.place_of({0.25, 0.75, -0.25}).squared_offset == 0);  // the middle of a cell
  CHECK(lattice.place_of({0.5, 0, 0}).squared_offset == 0.75);       // a corner
  CHECK(lattice.place_of({-0.0, 0, 0}).hash == lattice.place_of({0, 0, 0}).hash);
  CHECK_FALSE(Lattice(1e-100).place_of({1e300, 0, 0}).cell.allFinite());
}

// ---- Representatives

ChosenPoints choose_all(TiledScan& scan, double edge, std::uint64_t represented_ids = 0) {
  return choose_points(scan.store, scan.store.tiling().tiles_in({}), edge, represented_ids, scan.job.spill,
                       scan.job.workers);
}

std::vector<std::size_t> chosen_ids(TiledScan& scan, double edge) {
  const Tiling& tiling = scan.store.tiling();
  const ChosenPoints chosen = choose_all(scan, edge);
  std::vector<std::size_t> ids;
  for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
    const std::vector<ScanPoint> points = scan.store.points(t);
    for (LocalIndex p = 0; p < points.size(); ++p)
      if (chosen.rows.contains(tiling.tiles[t].row(p))) ids.push_back(value(points[p].id));
  }
  CHECK(chosen.count == ids.size());
  CHECK_FALSE(chosen.represented);
  return ids;
}

TEST_CASE(
    "the point nearest to its middle represents a cell, of several the one with the lowest coordinates") {
  const auto chosen_of = [](const std::vector<Eigen::Vector3d>& positions) {
    TiledScan scan(Cloud{positions, {}}, tiled({}, 1));
    const std::vector<std::size_t> ids = chosen_ids(scan, 10);
    REQUIRE(ids.size() == 1);
    return ids[0];
  };
  CHECK(chosen_of({{1, 1, 1}}) == 0);
  CHECK(chosen_of({{1, 5, 5}, {4, 5, 5}, {9, 5, 5}}) == 1);
  CHECK(chosen_of({{6, 5, 5}, {4, 5, 5}}) == 1);  // a tie
  CHECK(chosen_of({{4, 5, 5}, {4, 5, 5}}) == 0);  // copies
  CHECK(chosen_of({{-11, -15, -15}, {-14, -15, -15}, {-19, -15, -15}}) == 1);
}

TEST_CASE("each point of the input has the representative of its cell, copies too") {
  const Cloud cloud = scattered(400'000, 3).scaled(1000).with_duplicates(1000, 4);
  Config small;
  small.run.memory_limit = std::uint64_t{64} << 20;
  TiledScan scan(cloud, small);
  const ChosenPoints chosen = choose_all(scan, 20, cloud.size());
  REQUIRE(chosen.represented);
  const std::map<CellKey, std::size_t> expected = plainly_chosen(cloud, 20);
  std::vector<int> times(cloud.size());
  std::size_t wrong = 0;
  for (std::size_t block = 0; block < chosen.represented->lists(); ++block) {
    chosen.represented->for_each(block, [&](const Represented& r) {
      ++times[value(r.id)];
      wrong += value(r.representative) / kRepresentedBlock != block;
      wrong += value(r.representative) != expected.at(cell_of(cloud.positions[value(r.id)], 20));
    });
  }
  CHECK(wrong == 0);
  CHECK(std::all_of(times.begin(), times.end(), [](int t) { return t == 1; }));
}

TEST_CASE("a point that is too far away for the edge is an error that names it") {
  Cloud cloud = plane(3);
  cloud.positions[4] = {1e30, 0, 0};
  for (const std::int64_t tile_points : {1, 100}) {
    TiledScan scan(cloud, tiled({}, tile_points));
    CHECK_THROWS_WITH(choose_all(scan, 1e-300),
                      Contains("is too far away for a resolution of 1e-300: a larger one is needed"));
  }
}

// ---- Their stores

struct ThinnedStore {
  ThinnedStore(const Cloud& cloud, std::int64_t tile_points_below, std::uint64_t tile_points,
               std::uint64_t cell_points, double edge = 0.05)
      : below(cloud, tiled({}, tile_points_below)),
        chosen(choose_points(below.store, below.store.tiling().tiles_in({}), edge, 0, below.job.spill,
                             below.job.workers)),
        join(join_tiles(below.store.tiling(), chosen, tile_points, cell_points)),
        store(store_chosen(below.store, chosen, join, files(below), below.job.workers)) {}

  static StoreFiles files(const TiledScan& scan) {
    return {StoreFile(scan.job.spill.file("chosen")), StoreFile(scan.job.spill.file("chosen-normals")),
            scan.job.spill};
  }

  TiledScan below;
  ChosenPoints chosen;
  TileJoin join;
  TileStore store;
};

bool same(const ScanPoint& a, const ScanPoint& b) {
  return a.id == b.id && a.position() == b.position();
}

TEST_CASE("a thinned store has the chosen points in their order, with their normals, in tight cells") {
  Cloud cloud = scattered(20'000, 1).noisy(0.2, 1);
  for (const Eigen::Vector3d& p : cloud.positions) cloud.normals.push_back(2 * p);
  for (const std::int64_t tile_points_below : {50, 500, 1'000'000}) {
    for (const std::uint64_t tile_points : {1, 300, 5'000, 1'000'000}) {
      INFO("tiles of " << tile_points << " over tiles of " << tile_points_below);
      const ThinnedStore thin(cloud, tile_points_below, tile_points, 32);
      const Tiling &tiling = thin.store.tiling(), &below = thin.below.store.tiling();
      CHECK(tiling.check());
      CHECK(tiling.points() == thin.chosen.count);
      std::vector<ScanPoint> expected, found;
      for (TileIndex t = 0; t < below.tiles.size(); ++t) {
        const std::vector<ScanPoint> points = thin.below.store.points(t);
        for (LocalIndex p = 0; p < points.size(); ++p)
          if (thin.chosen.rows.contains(below.tiles[t].row(p))) expected.push_back(points[p]);
      }
      std::size_t wrong = 0;
      for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
        const std::vector<ScanPoint> points = thin.store.points(t);
        const std::vector<Eigen::Vector3d> normals = thin.store.normals(t);
        REQUIRE(normals.size() == points.size());
        for (std::size_t p = 0; p < points.size(); ++p) wrong += normals[p] != 2 * points[p].position();
        found.insert(found.end(), points.begin(), points.end());
      }
      CHECK(wrong == 0);
      REQUIRE(found.size() == expected.size());
      CHECK(std::equal(found.begin(), found.end(), expected.begin(), same));
      for (const Cell& cell : tiling.cells) {
        Eigen::AlignedBox3d box;
        for (std::uint64_t i = 0; i < cell.points; ++i) {
          const TileIndex t = tiling.tile_of_row(Row{value(cell.first_row) + i});
          const LocalIndex p = tiling.tiles[t].local(Row{value(cell.first_row) + i});
          box.extend(thin.store.points(t)[p].position());
        }
        wrong += box.min() != cell.box.min() || box.max() != cell.box.max();
        if (wrong > 0 || tiling.cells.size() > 400) break;  // each cell reads its tile again
      }
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("tiles and cells that have become small are put together, up to the size that is wanted") {
  const ThinnedStore thin(scattered(40'000, 2), 400, 1'000, 40, 0.02);
  const Tiling &tiling = thin.store.tiling(), &below = thin.below.store.tiling();
  CHECK(below.tiles.size() > 100);
  const std::uint64_t points = thin.chosen.count;
  CHECK(tiling.tiles.size() >= points / 1'000);
  CHECK(tiling.tiles.size() <= 4 * points / 1'000);
  for (const Tile& tile : tiling.tiles) CHECK(tile.points <= 1'000);
  for (const Cell& cell : tiling.cells) CHECK(cell.points <= 40);
  CHECK(tiling.cells.size() <= 8 * points / 40);
  CHECK(tiling.cells.size() < below.cells.size() / 2);
}

// ---- Levels

TEST_CASE("a resolution, every point and the paper's method have no other level than the first") {
  Config config;
  CHECK(has_levels(config));
  config.scale.min_hole = 20;
  CHECK(has_levels(config));
  config = {};
  config.scale.resolution = 3;
  CHECK_FALSE(has_levels(config));
  config = {};
  config.scale.every_point = true;
  CHECK_FALSE(has_levels(config));
  config = {};
  config.loops.method = LoopMethod::kPaper;
  CHECK_FALSE(has_levels(config));
}

// ---- Runs at a resolution, with ids and results of the whole input

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
