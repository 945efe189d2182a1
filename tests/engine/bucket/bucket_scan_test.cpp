// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/bucket_scan.hpp"

#include "tests/support/hostile.hpp"
#include "tests/support/memory_scan.hpp"
#include "tests/support/tile.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

std::vector<PointId> finite_ids(const Cloud& cloud) {
  std::vector<PointId> ids;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.positions[i].allFinite()) ids.push_back(PointId{i});
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
      for (const ScanPoint& p : scan.store.cell(c)) {
        misplaced += !Eigen::AlignedBox3d(tiling.cells[c].box).contains(p.position());
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
      const std::vector<ScanPoint> points = scan.store.points(t);
      CHECK(points.size() <=
            static_cast<std::size_t>(std::max<std::int64_t>(scan.config.run.tile_points, 1)));
      scan.store.for_each_duplicate(t, [&](const Duplicate& d) {
        const ScanPoint& owner = points.at(d.of);
        wrong_owners += owner.position() != cloud.positions[value(d.id)] || !(owner.id < d.id);
        ids.push_back(d.id);
      });
    }
    CHECK(wrong_owners == 0);
    std::sort(ids.begin(), ids.end());
    CHECK(ids == finite_ids(cloud));
  }
}

TEST_CASE("given normals stay with their points, be they unit vectors or not even numbers") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Cloud cloud = cloud_of(seed).with_random_normals(seed);
    const TiledScan scan(cloud, tiling_of(seed));
    std::size_t wrong = 0;
    for (TileIndex t = 0; t < scan.store.tiling().tiles.size(); ++t) {
      const std::vector<ScanPoint> points = scan.store.points(t);
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

// All tiles hold no more points than allowed, all cells few points, and none is wide compared with its
// distance to the densest place.
void check_division(const Cloud& cloud, std::int64_t tile_points) {
  const TiledScan scan(cloud, tiled({}, tile_points));
  const Tiling& tiling = scan.store.tiling();
  CHECK(tiling.points() == distinct_ids(cloud).size());
  for (const Tile& tile : tiling.tiles) CHECK(tile.points <= static_cast<std::uint64_t>(tile_points));
  std::uint64_t most = 0;
  for (const Cell& cell : tiling.cells) most = std::max(most, cell.points);
  CHECK(most <= 128);
}

TEST_CASE("cells with more points than a tile may hold divide, however dense the points are") {
  const Cloud surface = plane(100);
  Random random(1);
  check_division(volume_cluster(60'000, 1), 2'000);
  check_division(volume_cluster(60'000, 1).shuffled(1), 2'000);
  check_division(log_uniform(50'000, 1), 2'000);
  check_division(scattered(1'000, 1).scaled(1e6).joined(surface), 2'000);
  Cloud outliers = surface;
  for (int i = 0; i < 3'000; ++i)
    outliers.positions.push_back({std::pow(10, random.uniform(8, 15)), random.uniform(-1e15, 1e15), 0});
  check_division(outliers, 500);
}

TEST_CASE("copies of a point are merged as they stream: a tile never holds them in memory") {
  const Cloud surface = plane(50);
  for (const Cloud& cloud : {coincident(50'000), surface.joined(coincident(50'000)).shuffled(2),
                             coincident(20'000).joined(coincident(20'000).translated({1, 0, 0}))}) {
    const TiledScan scan(cloud, tiled({}, 1'000));
    std::uint64_t raw = 0, copies = 0;
    for (TileIndex t = 0; t < scan.store.tiling().tiles.size(); ++t) {
      raw = std::max(raw, scan.store.tiling().tiles[t].raw);
      scan.store.for_each_duplicate(t, [&](const Duplicate&) { ++copies; });
    }
    CHECK(raw <= 1'000);
    CHECK(copies + scan.store.tiling().points() == cloud.size());
  }
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
    CHECK_THROWS_WITH(changed(after), Contains("the input changed while it was read"));
}

}  // namespace
}  // namespace lacuna
