#include "engine/core/index_file.hpp"

#include "tests/support/tiled_scan.hpp"
#include "tests/support/vdb_grids.hpp"

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

void check_index(const Cloud& cloud, std::int64_t tile_points) {
  const TiledScan scan(cloud, tiled({}, tile_points));
  const Tiling& tiling = scan.store.tiling();
  const std::filesystem::path file = scan.folder / "cells.vdb";
  save_index(tiling, file);

  const auto grids = test::read_vdb_grids(file);
  REQUIRE(grids.size() == 2);
  const test::VdbGrid &points = grids.at("points"), &tiles = grids.at("tile");
  CHECK(points.voxel == tiling.grid.edge());
  CHECK(tiles.voxel == tiling.grid.edge());
  CHECK(points.background == 0);
  CHECK(tiles.background == -1);
  CHECK(points.values.size() == tiling.cells.size());
  CHECK(tiles.values.size() == tiling.cells.size());
  std::size_t wrong = 0;
  for (std::uint32_t cell = 0; cell < tiling.cells.size(); ++cell) {
    const CellCoord& at = tiling.cells[cell].coord;
    wrong += std::uint64_t(points.values.at(at)) != tiling.cells[cell].points;
    wrong += TileIndex(tiles.values.at(at)) != tiling.tile_of_cell(cell);
  }
  CHECK(wrong == 0);
}

TEST_CASE("OpenVDB reads back each cell of the index, with its points and its tile") {
  check_index(plane(60), 200);
  check_index(hard_cloud(4), 100);
  check_index(hard_cloud(4).translated({-5e5, 5.4e6, 300}), 1'000'000);
  check_index(Cloud{}, 100);
}

}  // namespace
}  // namespace lacuna
