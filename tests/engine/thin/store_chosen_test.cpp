// SPDX-License-Identifier: Apache-2.0
#include "engine/thin/thin.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

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

}  // namespace
}  // namespace lacuna
