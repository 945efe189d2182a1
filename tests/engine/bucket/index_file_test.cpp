#include "engine/bucket/index_file.hpp"

#include "engine/run/error.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/tile.hpp"
#include "tests/support/tiled_scan.hpp"
#include "tests/support/vdb_grids.hpp"

#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// A scan whose workspace keeps its index.
TiledScan kept(const Cloud& cloud, std::int64_t tile_points) {
  Config config = tiled({}, tile_points);
  config.run.keep_index = true;
  return TiledScan(cloud, config);
}

bool same_box(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  return a.min() == b.min() && a.max() == b.max();
}

void check_same(const Tiling& a, const Tiling& b) {
  REQUIRE(a.cells.size() == b.cells.size());
  REQUIRE(a.nodes.size() == b.nodes.size());
  REQUIRE(a.tiles.size() == b.tiles.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < a.cells.size(); ++i) {
    const Cell &x = a.cells[i], &y = b.cells[i];
    wrong += !same_box(x.box, y.box) || x.first_row != y.first_row || x.points != y.points;
  }
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const CellNode &x = a.nodes[i], &y = b.nodes[i];
    wrong += !same_box(x.box, y.box) || x.first != y.first || x.last != y.last || x.left != y.left ||
             x.right != y.right || x.points != y.points;
  }
  for (std::size_t i = 0; i < a.tiles.size(); ++i) {
    const Tile &x = a.tiles[i], &y = b.tiles[i];
    wrong += x.first_cell != y.first_cell || x.last_cell != y.last_cell || x.first_row != y.first_row ||
             x.raw != y.raw || x.points != y.points;
  }
  CHECK(wrong == 0);
}

// A surface, a cell with more points than a tile may hold, copies, and points far from all others.
Cloud mixed_cloud() {
  return plane(120)
      .joined(scattered(3000, 1).scaled(1e-3).translated({30.2, 30.2, 0}))
      .joined(coincident(50).translated({7, 7, 0}))
      .joined(scattered(25, 2).scaled(1e8));
}

TEST_CASE("the index that a workspace keeps is read back to the same tiling") {
  for (const Cloud& cloud : {mixed_cloud(), mixed_cloud().translated({5.4e6, -3.2e6, 300}).scaled(0x1p-10),
                             random_cloud(77), plane(30).scaled(1e-9), plane(30).scaled(1e120), Cloud{}}) {
    for (const std::int64_t tile_points : {500, 100'000}) {
      const TiledScan scan = kept(cloud, tile_points);
      const StoredIndex stored = read_index(scan.folder / "index.vdb");
      check_same(stored.tiling, scan.store.tiling());
      CHECK(stored.index.cells().finest == scan.survey.grid.finest);
      CHECK(stored.index.cells().shift == scan.survey.grid.shift);
      CHECK(stored.index.cells().origin == scan.survey.grid.origin);
    }
  }
}

TEST_CASE("the index that is read back finds the first cell of the tiling at a place, and others follow") {
  const TiledScan scan = kept(mixed_cloud(), 500);
  const auto [index, tiling] = read_index(scan.folder / "index.vdb");
  const CellGrid& grid = index.cells();
  std::size_t far = 0, wrong = 0, followers = 0;
  for (std::uint32_t c = 0; c < tiling.cells.size(); ++c) {
    std::vector<Eigen::Vector3d> positions;
    for (const StoredPoint& p : scan.store.cell(c)) positions.push_back(p.position());
    std::vector<std::uint32_t> numbers(positions.size());
    index.find(positions, numbers);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (numbers[i] == CellIndex::kNoCell) {
        ++far;
        continue;
      }
      // All from the first to this one lie in the same voxel.
      for (std::uint32_t between = numbers[i]; between <= c; ++between)
        wrong += grid.cell_of(tiling.cells[between].box.min()) != grid.cell_of(positions[i]);
      wrong += numbers[i] > c;
      followers += numbers[i] < c;
    }
  }
  CHECK(wrong == 0);
  CHECK(followers > 1000);
  CHECK(far >= 20);
  CHECK(far < 500);
}

TEST_CASE(
    "OpenVDB's own reader opens the index: cells in world coordinates, with the places of their points") {
  const Eigen::Vector3d place(500'000, 5'400'000, 300);
  const TiledScan scan = kept(plane(60).scaled(0x1p-10).translated(place), 500);
  const auto grids = test::read_vdb_grids(scan.folder / "index.vdb");
  REQUIRE(grids.size() == 1);
  const test::VdbGrid& cells = grids.at("cell");
  CHECK(cells.background == -1);
  CHECK(cells.voxel == scan.survey.grid.edge());
  std::size_t outside = 0, points = 0;
  for (const auto& [coord, number] : cells.values) {
    const Eigen::AlignedBox3d voxel = cells.box(coord);
    const Cell& cell = scan.store.tiling().cells.at(static_cast<std::size_t>(number));
    outside += !voxel.contains(cell.box);
    points += cell.points;
  }
  CHECK(outside == 0);
  CHECK(points == 3600);
}

TEST_CASE("an index that is cut short, or another file, is refused with its name") {
  const TiledScan scan = kept(plane(40), 500);
  const fs::path whole = scan.folder / "index.vdb", cut = scan.folder / "cut.vdb";
  std::ifstream in(whole, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{10}, bytes.size() / 4, bytes.size() / 2, bytes.size() - 50}) {
    std::ofstream(cut, std::ios::binary) << bytes.substr(0, length);
    INFO(length << " bytes of " << bytes.size());
    CHECK_THROWS_WITH(read_index(cut), Catch::Contains("cut.vdb: cannot read"));
  }
  CHECK_THROWS_AS(read_index(scan.folder / "none.vdb"), Error);
}

}  // namespace
}  // namespace lacuna
