// From places to cells, and points on their way into the rows of their tiles.
#include "engine/core/cell_index.hpp"

#include "engine/core/error.hpp"
#include "engine/core/tile_store.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <thread>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

using test::ScratchFolder;

std::int32_t cell_along_axis(double x, double origin, const CellGrid& grid) {
  const double index = std::floor(std::ldexp(x, -grid.finest)) - origin;
  const double last = CellGrid::kLast;
  return static_cast<std::int32_t>(std::clamp(index, -last, last)) >> grid.shift;
}

TEST_CASE("the cells of many positions are those of each, rounded down, whatever their size") {
  Random random(1);
  const std::vector<double> hard = {
      0.0, -0.0, 1e-320, -1e-320, 1, -1, std::nextafter(1, 0), std::nextafter(-1, -2),
      1e9, -1e9, 1e300,  -1e300};
  for (const CellGrid grid : {CellGrid{}, CellGrid{-7, 0}, CellGrid{3, 2}, CellGrid{-500, 30},
                              CellGrid{-10, 1, {5.4e9, -1e12, 3}}}) {
    std::vector<Eigen::Vector3d> positions;
    for (const double x : hard) positions.emplace_back(x, -x, std::ldexp(x, grid.finest));
    for (int i = 0; i < 1000; ++i) {
      positions.emplace_back(random.uniform(-1e4, 1e4), random.uniform(-1, 1), random.uniform(-1e10, 1e10));
    }
    std::vector<CellCoord> cells(positions.size());
    grid.cells_of(positions, cells);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis)
        wrong += cells[i][axis] != cell_along_axis(positions[i][axis], grid.origin[std::size_t(axis)], grid);
      wrong += cells[i] != grid.cell_of(positions[i]);
    }
    INFO("finest " << grid.finest << ", shift " << grid.shift);
    CHECK(wrong == 0);
  }
}

TEST_CASE("every counted cell is found by a position in it, and no other") {
  Random random(2);
  std::vector<CountedCell> counted;
  std::map<CellCoord, std::uint32_t> numbers;
  const auto count = [&](const CellCoord& cell) {
    if (numbers.emplace(cell, static_cast<std::uint32_t>(numbers.size())).second)
      counted.push_back({cell, 1});
  };
  constexpr std::int32_t kLast = CellGrid::kLast;
  for (const std::int32_t x : {-kLast, -kLast + 1, -1, 0, 7, 8, kLast - 1, kLast}) {
    for (const std::int32_t y : {-kLast, 0, kLast}) count({x, y, 5});
  }
  for (int i = 0; i < 3000; ++i) {  // mostly alone in their leaves: the table grows
    const auto at = [&] { return static_cast<std::int32_t>(random.whole(-500, 500)); };
    count({at(), at(), at()});
  }
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::uint32_t> expected;
  const auto ask = [&](const CellCoord& cell) {
    positions.emplace_back(cell[0] + 0.25, cell[1] + 0.5, cell[2]);
    const auto found = numbers.find(cell);
    expected.push_back(found == numbers.end() ? CellIndex::kNoCell : found->second);
  };
  for (const CountedCell& cell : counted) {
    ask(cell.coord);
    ask({cell.coord[0], cell.coord[1], cell.coord[2] + 1});  // mostly the same leaf, without points
    ask({cell.coord[1], cell.coord[2], cell.coord[0]});      // mostly another leaf
  }
  std::vector<std::uint32_t> cells(positions.size());
  CellIndex(CellGrid{}, std::span(counted).first(1000), std::span(counted).subspan(1000))
      .find(positions, cells);
  CHECK(cells == expected);
  CHECK(std::count(cells.begin(), cells.end(), CellIndex::kNoCell) > 3000);
}

TEST_CASE("an index of nothing finds nothing") {
  const std::vector<Eigen::Vector3d> positions = {{0, 0, 0}, {NAN, 0, 0}, {-INFINITY, 0, 0}};
  std::vector<std::uint32_t> cells(3);
  CellIndex(CellGrid{}, {}).find(positions, cells);
  CHECK(cells == std::vector<std::uint32_t>(3, CellIndex::kNoCell));
}

TEST_CASE("a column is filled in many runs at once, whatever the memory and the lengths of the pieces") {
  for (const std::uint64_t memory : {0, 1000, 30'000, 10'000'000}) {
    const ScratchFolder folder;
    Column<std::uint64_t> column(folder / "column");
    std::vector<std::vector<std::uint64_t>> runs(17);
    std::vector<std::uint64_t> first_rows;
    for (std::size_t run = 0; run < runs.size(); ++run) first_rows.push_back(run * 5000);
    {
      ColumnFiller<std::uint64_t> filler(column, first_rows, memory);
      Random random(3);
      for (int i = 0; i < 2000; ++i) {
        const auto run = static_cast<std::size_t>(random.whole(0, 15));  // the last one stays empty
        const std::vector<std::uint64_t> piece(static_cast<std::size_t>(random.whole(0, 30)),
                                               static_cast<std::uint64_t>(i + 1));
        filler.append(run, piece);
        runs[run].insert(runs[run].end(), piece.begin(), piece.end());
      }
      filler.finish();
    }
    INFO(memory << " bytes");
    for (std::size_t run = 0; run < runs.size(); ++run) {
      REQUIRE(runs[run].size() < 5000);
      CHECK(column.read(first_rows[run], runs[run].size()) == runs[run]);
    }
  }
}

// Of 3000 and 5000 points.
std::vector<Tile> two_tiles() {
  return {{.first_row = Row{0}, .raw = 3000}, {.first_row = Row{3008}, .raw = 5000}};
}

StoredPoint numbered(std::uint64_t id) {
  return {double(id), 0, 0, PointId{id}};
}

TEST_CASE("points that come from several threads are in their tile once each, beside their normals") {
  const ScratchFolder folder;
  TileStore store(folder / "", two_tiles(), 2, Precision::kSingle, true, 1 << 16);
  TileStore::Filler filler(store, 4000);
  std::vector<std::thread> threads;
  for (std::uint64_t first = 0; first < 8000; first += 1000) {
    threads.emplace_back([&, first] {
      for (std::uint64_t id = first; id < first + 1000; id += 10) {
        std::vector<StoredPoint> points;
        std::vector<StoredNormal> normals;
        for (std::uint64_t i = id; i < id + 10; ++i) {
          points.push_back(numbered(i));
          normals.push_back({double(i), 1, 2});
        }
        filler.append(id < 3000 ? 0 : 1, points, normals);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  filler.finish();
  for (const TileIndex tile : {0, 1}) {
    const std::vector<StoredPoint> points = store.raw_points(tile);
    const std::vector<StoredNormal> normals = store.raw_normals(tile);
    REQUIRE(points.size() == normals.size());
    std::vector<std::uint64_t> ids, expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      ids.push_back(value(points[i].id));
      if (points[i].x != normals[i].x) FAIL_CHECK("a normal of another point");
    }
    std::sort(ids.begin(), ids.end());
    for (std::uint64_t id = tile == 0 ? 0 : 3000; id < (tile == 0 ? 3000 : 8000); ++id)
      expected.push_back(id);
    CHECK(ids == expected);
  }
}

TEST_CASE("a tile that gets more or fewer points than were counted is an error") {
  const ScratchFolder folder;
  TileStore store(folder / "", two_tiles(), 2, Precision::kDouble, false, 1 << 16);
  TileStore::Filler filler(store, 4000);
  const std::vector<StoredPoint> points(3000, numbered(1));
  filler.append(0, points, {});
  CHECK_THROWS_AS(filler.append(0, std::span(points).first(1), {}), Error);
  CHECK_THROWS_AS(filler.finish(), Error);
}

}  // namespace
}  // namespace lacuna
