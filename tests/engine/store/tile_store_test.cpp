// Points on their way into the rows of their tiles, and back.
#include "engine/store/tile_store.hpp"

#include "engine/run/error.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/open_files.hpp"
#include "tests/support/scratch_folder.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <unistd.h>

namespace lacuna {
namespace {

using test::ScratchFolder;

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

TEST_CASE("a tile whose points were cut off on disk is an error, in either precision") {
  for (const Precision precision : {Precision::kSingle, Precision::kDouble}) {
    const ScratchFolder folder;
    TileStore store(folder / "", two_tiles(), 2, precision, false, 1 << 16);
    TileStore::Filler filler(store, 4000);
    filler.append(0, std::vector<StoredPoint>(3000, numbered(1)), {});
    filler.append(1, std::vector<StoredPoint>(5000, numbered(2)), {});
    filler.finish();
    REQUIRE(test::cut_open_file(getpid(), "points"));
    CHECK(store.raw_points(0).size() == 3000);
    CHECK_THROWS_WITH(store.raw_points(1),
                      Catch::Matchers::Contains((folder / "points").string() + ": the file was cut short"));
  }
}

}  // namespace
}  // namespace lacuna
