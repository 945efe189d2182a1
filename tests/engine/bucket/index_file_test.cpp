#include "engine/bucket/index_file.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/vdb_grids.hpp"

#include <map>
#include <vector>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

// Cells in clumps, as those of surfaces are, and some far from all others.
std::vector<IndexedCell> random_cells(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::map<CellCoord, IndexedCell> cells;
  while (cells.size() < count) {
    const auto centre = static_cast<std::int32_t>(random.whole(-3, 3) * (random.chance(0.05) ? 100'000'000 : 40));
    CellCoord at{};
    for (std::int32_t& axis : at) axis = centre + static_cast<std::int32_t>(random.whole(-9, 9));
    cells[at] = {at, static_cast<std::int32_t>(random.whole(1, 1000)), static_cast<std::int32_t>(random.whole(-1, 50))};
  }
  std::vector<IndexedCell> list;
  for (const auto& [at, cell] : cells) list.push_back(cell);
  return list;
}

void check_index(const CellGrid& grid, const std::vector<IndexedCell>& cells) {
  const test::ScratchFolder folder;
  const std::filesystem::path file = folder / "index.vdb";
  save_index(grid, cells, file);
  const auto grids = test::read_vdb_grids(file);
  REQUIRE(grids.size() == 2);
  const test::VdbGrid &points = grids.at("points"), &tiles = grids.at("tile");
  CHECK(points.voxel == grid.edge());
  CHECK(tiles.voxel == grid.edge());
  CHECK(points.background == 0);
  CHECK(tiles.background == -1);
  CHECK(points.values.size() == cells.size());
  CHECK(tiles.values.size() == cells.size());
  std::size_t wrong = 0;
  for (const IndexedCell& cell : cells)
    wrong += points.values.at(cell.coord) != cell.points || tiles.values.at(cell.coord) != cell.tile;
  CHECK(wrong == 0);
}

TEST_CASE("OpenVDB reads back each cell of the index, with its points and its tile") {
  check_index(CellGrid{}, random_cells(1, 500));
  check_index(CellGrid{-7, 2}, random_cells(2, 5'000));
  check_index(CellGrid{-3, 0, {5.4e9, -1e8, 3}}, random_cells(3, 40));
  check_index(CellGrid{}, {});
}

}  // namespace
}  // namespace lacuna
