#include "engine/passes/bucket.hpp"

#include "engine/core/error.hpp"
#include "tests/support/memory_scan.hpp"
#include "tests/support/tile.hpp"
#include "tests/support/tiled_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

std::vector<PointId> finite_ids(const Cloud& cloud) {
  std::vector<PointId> ids;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.positions[i].allFinite()) ids.push_back(PointId{i});
  }
  return ids;
}

Cloud cloud_of(std::uint64_t seed) {
  return seed % 10 == 0 ? hard_cloud(seed) : random_cloud(8000 + seed);
}

Config tiling_of(std::uint64_t seed) {
  return tiled({}, std::array<std::int64_t, 4>{1, 30, 1000, 100'000}[seed % 4], seed % 3 == 0 ? 8 : 2);
}

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

TEST_CASE("every finite point is stored once, in a row of its cell, or is a duplicate of one that is") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Cloud cloud = cloud_of(seed);
    const TiledScan scan(cloud, tiling_of(seed));
    const Tiling& tiling = scan.store.tiling();
    INFO("seed " << seed << ", " << tiling.tiles.size() << " tiles");
    CHECK(tiling.check());

    std::vector<PointId> ids;
    std::size_t misplaced = 0, moved = 0;
    for (std::uint32_t c = 0; c < tiling.cells.size(); ++c) {
      for (const StoredPoint& p : scan.store.cell(c)) {
        misplaced += tiling.grid.cell_of(p.position()) != tiling.cells[c].coord;
        moved += p.position() != cloud.positions[value(p.id)];
        ids.push_back(p.id);
      }
    }
    CHECK(misplaced == 0);
    CHECK(moved == 0);
    std::sort(ids.begin(), ids.end());
    CHECK(ids == distinct_ids(cloud));

    std::size_t wrong_owners = 0;
    for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
      const std::vector<StoredPoint> points = scan.store.points(t);
      const std::vector<Duplicate> duplicates = scan.store.duplicates(t);
      CHECK(points.size() + duplicates.size() == tiling.tiles[t].raw);
      for (const Duplicate& d : duplicates) {
        const StoredPoint& owner = points.at(d.of);
        wrong_owners += owner.position() != cloud.positions[value(d.id)] || !(owner.id < d.id);
        ids.push_back(d.id);
      }
    }
    CHECK(wrong_owners == 0);
    std::sort(ids.begin(), ids.end());
    CHECK(ids == finite_ids(cloud));
  }
}

TEST_CASE("a tile's points are those of its cells, one after the other") {
  const TiledScan scan(hard_cloud(2), tiled({}, 200));
  const Tiling& tiling = scan.store.tiling();
  REQUIRE(tiling.tiles.size() > 5);
  for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
    std::vector<PointId> of_tile, of_cells;
    for (const StoredPoint& p : scan.store.points(t)) of_tile.push_back(p.id);
    for (std::uint32_t c = tiling.tiles[t].first_cell; c < tiling.tiles[t].last_cell; ++c) {
      for (const StoredPoint& p : scan.store.cell(c)) of_cells.push_back(p.id);
    }
    CHECK(of_tile == of_cells);
  }
}

TEST_CASE("given normals stay with their points, be they unit vectors or not even numbers") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Cloud cloud = cloud_of(seed).with_random_normals(seed);
    const TiledScan scan(cloud, tiling_of(seed));
    std::size_t wrong = 0;
    for (TileIndex t = 0; t < scan.store.tiling().tiles.size(); ++t) {
      const std::vector<StoredPoint> points = scan.store.points(t);
      const std::vector<Eigen::Vector3d> normals = scan.store.normals(t);
      REQUIRE(normals.size() == points.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis)
          wrong += !same(normals[i][axis], cloud.normals[value(points[i].id)][axis]);
      }
    }
    INFO("seed " << seed);
    CHECK(wrong == 0);
  }
}

// Another cloud from the second reading on.
class ChangingScan final : public PointSource {
 public:
  ChangingScan(const Cloud& first, const Cloud& second) : first_(first), second_(second) {}

  void rewind() override {
    ++readings_;
    first_.rewind();
    second_.rewind();
  }
  bool next(PointBatch& batch) override { return readings_ < 2 ? first_.next(batch) : second_.next(batch); }
  std::optional<std::uint64_t> expected_points() const override { return std::nullopt; }
  bool has_normals() const override { return false; }

 private:
  MemoryScan first_, second_;
  int readings_ = 0;
};

TEST_CASE("a scan whose first points are far sparser than all others is surveyed once more") {
  const Cloud surface = plane(200);
  const std::size_t alone = TiledScan(surface, {}).store.tiling().cells.size();
  const Cloud sparse = scattered(1'000, 1).scaled(1e6);
  const Cloud both = sparse.joined(surface);
  MemoryScan scan(both, 1'000);
  const TiledScan tiled(scan, {});
  CHECK(tiled.store.tiling().cells.size() >= 900 + alone / 20);
  CHECK(tiled.job.phases.size() > 2);  // survey, survey once more or twice, bucket
  for (const Cloud& even : {surface, coincident(50'000), sparse.joined(coincident(50'000))})
    CHECK(TiledScan(even, {}).store.tiling().points() > 0);
}

TEST_CASE("an input that changes between the two readings is an error") {
  const Cloud before = plane(40);
  const auto changed = [&](const Cloud& after) {
    ChangingScan scan(before, after);
    TiledScan(scan, tiled({}, 100));
  };
  CHECK_NOTHROW(changed(before));
  Cloud fewer = before, elsewhere = before, crowded = before;
  fewer.positions.pop_back();
  elsewhere.positions[7] = {1000, 1000, 1000};
  // Hundreds of points have come to the last one: as many as before, and each where some were counted.
  for (int i = 0; i < 300; ++i)
    crowded.positions[std::size_t(i)] = before.positions.back() + Eigen::Vector3d(1e-6 * (i + 1), 0, 0);
  Cloud finer = before;
  finer.positions[7].x() += 1e-12;
  for (const Cloud& after : {fewer, before.joined(line(1)), elsewhere, crowded, finer})
    CHECK_THROWS_WITH(changed(after), Catch::Contains("the input changed while it was read"));
}

}  // namespace
}  // namespace lacuna
