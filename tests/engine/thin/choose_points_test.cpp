// SPDX-License-Identifier: Apache-2.0
#include "engine/thin/choose_points.hpp"

#include "tests/support/thinned.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

ChosenPoints choose_all(TiledScan& scan, double edge, std::uint64_t represented_ids = 0) {
  return choose_points(scan.store, scan.store.tiling().tiles_in({}), edge, represented_ids, scan.job.spill,
                       scan.job.workers);
}

// Several tasks choose together.
std::vector<std::size_t> chosen_ids(TiledScan& scan, double edge, std::size_t tasks = 1) {
  const Tiling& tiling = scan.store.tiling();
  std::vector<std::size_t> ids;
  for (std::size_t task = 0; task < tasks; ++task) {
    const std::size_t before = ids.size();
    const ChosenPoints chosen =
        choose_points(scan.store, tiling.tiles_in({task, tasks}), edge, 0, scan.job.spill, scan.job.workers);
    for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
      const std::vector<ScanPoint> points = scan.store.points(t);
      for (LocalIndex p = 0; p < points.size(); ++p)
        if (chosen.rows.contains(tiling.tiles[t].row(p))) ids.push_back(value(points[p].id));
    }
    CHECK(chosen.count == ids.size() - before);
    CHECK_FALSE(chosen.represented);
  }
  std::sort(ids.begin(), ids.end());
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

TEST_CASE("whatever the tiles, the threads and the order, the same points represent cells of any size") {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Cloud cloud =
        scattered(3000, seed)
            .noisy(0.1, seed)
            .translated(seed % 2 == 0 ? Eigen::Vector3d(1e5, -3e5, 7) : Eigen::Vector3d(0, 0, 0))
            .with_unusable(20, seed);
    const Cloud shuffled = cloud.shuffled(seed);
    for (const double edge : {0.01, 0.05, 0.13, 0.9, 1e6}) {
      const std::vector<std::size_t> expected = plainly_chosen_ids(cloud, edge);
      for (const std::int64_t tile_points : {10, 100, 700, 1'000'000}) {
        INFO("seed " << seed << ", edge " << edge << ", tiles of " << tile_points);
        for (const std::int64_t threads : {1, 4}) {
          TiledScan scan(cloud, tiled({}, tile_points, threads));
          CHECK(chosen_ids(scan, edge) == expected);
          CHECK(chosen_ids(scan, edge, 3) == expected);
        }
        TiledScan scan(shuffled, tiled({}, tile_points));
        CHECK(chosen_ids(scan, edge) == plainly_chosen_ids(shuffled, edge));
      }
    }
  }
}

TEST_CASE("counts of cells are those of the chosen points in them") {
  TiledScan scan(scattered(5000, 7), tiled({}, 300));
  const ChosenPoints chosen = choose_all(scan, 0.05);
  const Tiling& tiling = scan.store.tiling();
  REQUIRE(chosen.in_cell.size() == tiling.cells.size());
  std::uint64_t all = 0, wrong = 0;
  for (std::size_t c = 0; c < tiling.cells.size(); ++c) {
    const std::uint64_t first = value(tiling.cells[c].first_row);
    std::uint32_t count = 0;
    for (std::uint64_t row = first; row < first + tiling.cells[c].points; ++row)
      count += chosen.rows.contains(Row{row});
    wrong += count != chosen.in_cell[c];
    all += count;
  }
  CHECK(wrong == 0);
  CHECK(all == chosen.count);
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

TEST_CASE("a store without points has no chosen ones") {
  TiledScan scan(Cloud{{}, {}}, Config());
  CHECK(choose_all(scan, 1).count == 0);
}

}  // namespace
}  // namespace lacuna
