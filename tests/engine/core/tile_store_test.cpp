#include "engine/core/tile_store.hpp"

#include "engine/core/error.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/scratch_folder.hpp"

#include <algorithm>
#include <thread>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

constexpr std::uint64_t kMemory = 1 << 20;

// Three tiles in a row along x: cells of edge 1 with these numbers of points. The second tile is longer than
// one part of for_each_point.
const std::vector<std::vector<std::uint64_t>> kCells = {{40, 25}, {3000, 1, 2999}, {7}};

Tiling three_tiles() {
  Tiling tiling;
  for (const std::vector<std::uint64_t>& cells : kCells) {
    Tile tile{.first_cell = std::uint32_t(tiling.cells.size())};
    for (const std::uint64_t points : cells) {
      tiling.cells.push_back({{std::int32_t(tiling.cells.size()), 0, 0}, points});
      tile.raw += points;
    }
    tile.last_cell = std::uint32_t(tiling.cells.size());
    const Tile before = tiling.tiles.empty() ? Tile{} : tiling.tiles.back();
    tile.first_row =
        Row{(value(before.first_row) + before.raw + kRowAlignment - 1) / kRowAlignment * kRowAlignment};
    tiling.tiles.push_back(tile);
  }
  CellNode root{.high = tiling.cells.back().coord, .last = std::uint32_t(tiling.cells.size())};
  tiling.nodes = {root};
  return tiling;
}

// Cell by cell; the id is the place in this list.
std::vector<StoredPoint> points_of(const Tiling& tiling) {
  Random random(1);
  std::vector<StoredPoint> points;
  for (const CountedCell& cell : tiling.cells) {
    for (std::uint64_t i = 0; i < cell.points; ++i)
      points.push_back(
          {cell.coord[0] + random.uniform(0, 1), random.uniform(0, 1), 0.1, PointId{points.size()}});
  }
  return points;
}

StoredNormal normal_of(const StoredPoint& p) {
  return {p.y, p.x, double(value(p.id))};
}

std::vector<StoredNormal> normals_of(std::span<const StoredPoint> points) {
  std::vector<StoredNormal> normals;
  for (const StoredPoint& p : points) normals.push_back(normal_of(p));
  return normals;
}

bool same(const StoredPoint& a, const StoredPoint& b) {
  return a.position() == b.position() && a.id == b.id;
}

bool same(std::span<const StoredPoint> a, std::span<const StoredPoint> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const StoredPoint& p, const StoredPoint& q) { return same(p, q); });
}

TileStore make_store(const test::ScratchFolder& folder) {
  return {folder.path(), three_tiles(), Precision::kDouble, true, kMemory};
}

struct Filled {
  test::ScratchFolder folder;
  TileStore store = make_store(folder);
  std::vector<StoredPoint> points = points_of(store.tiling());

  // All of them, a few at a time and the last first, from four threads.
  void fill() {
    TileStore::Filler filler(store, kMemory);
    std::vector<std::thread> threads;
    for (std::size_t thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&, thread] {
        for (TileIndex tile = 0; tile < kCells.size(); ++tile) {
          const std::span<const StoredPoint> all = of_tile(tile);
          for (std::size_t end = all.size(), part = 0; end > 0; ++part) {
            const std::size_t begin = end - std::min<std::size_t>(end, 100);
            if (part % 4 == thread) {
              const auto some = all.subspan(begin, end - begin);
              filler.append(tile, some, normals_of(some));
            }
            end = begin;
          }
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    filler.finish();
  }

  std::span<const StoredPoint> of_tile(TileIndex tile) const {
    std::uint64_t first = 0;
    for (TileIndex t = 0; t < tile; ++t) first += store.tiling().tiles[t].raw;
    return std::span(points).subspan(first, store.tiling().tiles[tile].raw);
  }
};

TEST_CASE("the tile store gives back what several threads have put into each tile, normals beside points") {
  Filled filled;
  filled.fill();
  for (TileIndex tile = 0; tile < kCells.size(); ++tile) {
    std::vector<StoredPoint> raw = filled.store.raw_points(tile);
    const std::vector<StoredNormal> normals = filled.store.raw_normals(tile);
    REQUIRE(normals.size() == raw.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) wrong += normals[i].z != double(value(raw[i].id));
    CHECK(wrong == 0);
    std::sort(raw.begin(), raw.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    CHECK(same(raw, filled.of_tile(tile)));
  }
}

TEST_CASE("a tile in cell order is read whole, by cell, and by runs of cells across tiles") {
  Filled filled;
  filled.fill();
  // The last point of every tile becomes a duplicate of its first one.
  std::vector<StoredPoint> kept;
  for (TileIndex tile = 0; tile < kCells.size(); ++tile) {
    const std::span<const StoredPoint> all = filled.of_tile(tile);
    std::vector<std::uint64_t> cells = kCells[tile];
    --cells.back();
    const auto distinct = all.first(all.size() - 1);
    filled.store.put(tile, distinct, normals_of(distinct), cells, std::vector<Duplicate>{{all.back().id, 0}});
    kept.insert(kept.end(), distinct.begin(), distinct.end());
  }
  filled.store.seal();
  const Tiling& tiling = filled.store.tiling();
  CHECK(tiling.points() == kept.size());

  std::vector<StoredPoint> by_tile, by_part, by_cell, by_run;
  for (TileIndex tile = 0; tile < kCells.size(); ++tile) {
    const std::vector<StoredPoint> points = filled.store.points(tile);
    const std::vector<Eigen::Vector3d> normals = filled.store.normals(tile);
    REQUIRE(normals.size() == points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (normals[i].z() != double(value(points[i].id))) FAIL_CHECK("normal " << i << " of tile " << tile);
    }
    by_tile.insert(by_tile.end(), points.begin(), points.end());
    filled.store.for_each_point(tile, [&](const StoredPoint& p) { by_part.push_back(p); });
    const std::vector<Duplicate> duplicates = filled.store.duplicates(tile);
    REQUIRE(duplicates.size() == 1);
    CHECK(duplicates[0].id == filled.of_tile(tile).back().id);
    CHECK(duplicates[0].of == 0);
  }
  for (std::uint32_t cell = 0; cell < tiling.cells.size(); ++cell) {
    const std::vector<StoredPoint> points = filled.store.cell(cell);
    by_cell.insert(by_cell.end(), points.begin(), points.end());
  }
  CHECK(same(by_tile, kept));
  CHECK(same(by_part, kept));
  CHECK(same(by_cell, kept));

  std::vector<Row> rows;
  filled.store.read_cells(std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}, by_run, rows);
  CHECK(same(by_run, kept));
  filled.store.read_cells(std::vector<std::uint32_t>{1, 2, 4}, by_run, rows);
  REQUIRE(by_run.size() == 24 + 3000 + 2998);
  REQUIRE(rows.size() == by_run.size());
  CHECK(rows[0] == Row{40});
  CHECK(rows[24] == tiling.tiles[1].first_row);
  CHECK(rows[24 + 3000] == tiling.cell_rows[4]);
  CHECK(same(by_run[24 + 3000], filled.points[65 + 3001]));
}

TEST_CASE("the tile store refuses more or fewer points than were counted") {
  Filled filled;
  const auto all = filled.of_tile(2);
  TileStore::Filler filler(filled.store, kMemory);
  filler.append(2, all, normals_of(all));
  CHECK_THROWS_AS(filler.append(2, all.first(1), normals_of(all.first(1))), Error);
  TileStore::Filler short_of_points(filled.store, kMemory);
  short_of_points.append(2, all, normals_of(all));
  CHECK_THROWS_AS(short_of_points.finish(), Error);
  const auto many = filled.of_tile(0);
  CHECK_THROWS_AS(filled.store.put(2, many, normals_of(many), std::vector<std::uint64_t>{65}, {}), Error);
}

}  // namespace
}  // namespace lacuna
