// SPDX-License-Identifier: Apache-2.0
// Points on their way into the rows of their tiles, and back.
#include "engine/store/tile_store.hpp"

#include "engine/run/error.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/open_files.hpp"
#include "tests/support/scratch_folder.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <catch2/catch.hpp>
#include <unistd.h>

namespace lacuna {
namespace {

using test::ScratchFolder;

StoreFiles files(const ScratchFolder& folder) {
  return {StoreFile(folder / "points"), StoreFile(folder / "normals"), folder / "duplicates"};
}

// Two tiles of 3000 and 5000 points.
std::vector<Tile> two_tiles() {
  return {{.first_row = Row{0}, .raw = 3000}, {.first_row = Row{3008}, .raw = 5000}};
}

ScanPoint numbered(std::uint64_t id) {
  return {double(id), 0, 0, PointId{id}};
}

// A point of cell c has x in [c, c + 1), so order in the store and place in space agree.
std::vector<ScanPoint> points_of_cell(std::uint32_t cell, std::uint64_t count, std::uint64_t first_id) {
  Random random(cell + 1);
  std::vector<ScanPoint> points;
  for (std::uint64_t i = 0; i < count; ++i)
    points.push_back({cell + random.uniform(), random.uniform(), random.uniform(), PointId{first_id + i}});
  return points;
}

using Values = std::vector<std::array<double, 4>>;

// Coordinates and id of each point, in order.
void append_values(Values& values, std::span<const ScanPoint> points) {
  for (const ScanPoint& p : points) values.push_back({p.x, p.y, p.z, double(value(p.id))});
}

TEST_CASE("points come back in tile order, and in cell order within a tile, with their ids and coordinates") {
  // By tile, the points of its cells. The second is longer than a part of for_each_point; the last is added
  // behind the others. One point of each tile but the last is a copy.
  const std::vector<std::vector<std::uint64_t>> cells_of_tile = {{40, 25}, {3000, 1, 2999}, {7}, {10, 2}};
  const ScratchFolder folder;
  std::vector<Tile> tiles;
  std::vector<std::vector<Cell>> cells;
  std::vector<std::vector<ScanPoint>> points;
  Values expected;
  std::uint64_t id = 100'000;  // ids fall while rows rise
  std::uint32_t cell = 0;
  for (const std::vector<std::uint64_t>& counts : cells_of_tile) {
    cells.emplace_back();
    points.emplace_back();
    for (const std::uint64_t count : counts) {
      const std::vector<ScanPoint> of_cell = points_of_cell(cell++, count, id -= count);
      cells.back().push_back({.points = count});
      for (const ScanPoint& p : of_cell) cells.back().back().box.extend(p.position());
      points.back().insert(points.back().end(), of_cell.begin(), of_cell.end());
    }
    append_values(expected, points.back());
    const std::uint64_t first = tiles.empty() ? 0 : value(tiles.back().first_row) + tiles.back().raw;
    tiles.push_back({.first_row = Row{aligned_row(first)}, .raw = points.back().size() + 1});
  }
  tiles.pop_back();
  TileStore store(files(folder), tiles, 4, Precision::kDouble, false, std::make_shared<BufferPool>(1 << 16));
  for (const TileIndex tile : {2, 0, 1}) {
    store.put(tile, points[tile], {}, cells[tile]);
    const Duplicate copy{PointId{tile}, LocalIndex{5}};
    store.add_duplicates(tile, {&copy, 1});
  }
  CHECK(store.next_tile() == 3);
  store.add_tile(points[3], {}, cells[3]);
  store.finish();

  const Tiling& tiling = store.tiling();
  REQUIRE(tiling.check());
  REQUIRE(tiling.cells.size() == cell);
  CHECK(tiling.points() == expected.size());
  Values by_tile, by_part, by_cell, by_run;
  for (TileIndex tile = 0; tile < tiling.tiles.size(); ++tile) {
    append_values(by_tile, store.points(tile));
    store.for_each_point(tile, [&](const ScanPoint& p) { append_values(by_part, {&p, 1}); });
    std::vector<PointId> copies;
    store.for_each_duplicate(tile, [&](const Duplicate& d) {
      copies.push_back(d.id);
      CHECK(d.of == 5);
    });
    CHECK(copies == (tile < 3 ? std::vector{PointId{tile}} : std::vector<PointId>{}));
  }
  std::vector<std::uint32_t> all_cells;
  for (std::uint32_t c = 0; c < cell; ++c) {
    append_values(by_cell, store.cell(c));
    all_cells.push_back(c);
  }
  CHECK(by_tile == expected);
  CHECK(by_part == expected);
  CHECK(by_cell == expected);

  std::vector<ScanPoint> read;
  std::vector<Row> rows;
  store.read_cells(all_cells, read, rows);
  append_values(by_run, read);
  CHECK(by_run == expected);

  store.read_cells(std::vector<std::uint32_t>{1, 2, 4, 7}, read, rows);
  Values some, expected_some;
  append_values(some, read);
  std::vector<Row> expected_rows;
  for (const std::uint32_t c : {1, 2, 4, 7}) {
    append_values(expected_some, store.cell(c));
    for (std::uint64_t i = 0; i < tiling.cells[c].points; ++i)
      expected_rows.push_back(Row{value(tiling.cells[c].first_row) + i});
  }
  CHECK(some == expected_some);
  CHECK(rows == expected_rows);
  CHECK(tiling.cells[2].first_row == tiling.tiles[1].first_row);
  CHECK(value(tiling.cells[4].first_row) == value(tiling.tiles[1].first_row) + 3001);
}

TEST_CASE("a tile whose points were cut off on disk is an error, in either precision") {
  for (const Precision precision : {Precision::kSingle, Precision::kDouble}) {
    const ScratchFolder folder;
    TileStore store(files(folder), two_tiles(), 2, precision, false, std::make_shared<BufferPool>(1 << 16));
    store.put(0, std::vector<ScanPoint>(3000, numbered(1)), {}, {});
    store.put(1, std::vector<ScanPoint>(5000, numbered(2)), {}, {});
    REQUIRE(test::cut_open_file(getpid(), "points"));
    CHECK(store.points(0).size() == 3000);
    CHECK_THROWS_WITH(store.points(1),
                      Catch::Matchers::Contains((folder / "points").string() + ": the file was cut short"));
  }
}

}  // namespace
}  // namespace lacuna
