// SPDX-License-Identifier: Apache-2.0
// From points to cells and tiles: the survey, the split, how far neighbours may be, and what a store holds.
#include "engine/bucket/bucket_scan.hpp"
#include "engine/bucket/order_tile.hpp"
#include "engine/bucket/split.hpp"
#include "engine/config/job.hpp"
#include "engine/model/distance_bound.hpp"
#include "engine/run/error.hpp"
#include "engine/survey/survey.hpp"
#include "tests/support/detected.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

// ---- Survey, split and reach

SurveyedScan survey(const Cloud& cloud, std::uint64_t memory = 1 << 30, std::size_t batch = 1000,
                    bool expected = true) {
  const ScratchFolder folder;
  Survey survey(memory, expected ? cloud.size() : 0, folder / "cells");
  MemoryScan scan(cloud, batch);
  for (PointBatch points; scan.next(points);) survey.add(points);
  return survey.finish();
}

std::map<CellCoord, std::uint64_t> counts_of(const std::vector<CountedCell>& cells) {
  std::map<CellCoord, std::uint64_t> counts;
  for (const CountedCell& cell : cells) counts[cell.coord] += cell.points;
  return counts;
}

std::map<CellCoord, std::uint64_t> counted_plainly(const Cloud& cloud, const CellGrid& grid) {
  std::map<CellCoord, std::uint64_t> counts;
  for (const Eigen::Vector3d& p : cloud.positions)
    if (p.allFinite()) ++counts[grid.cell_of(p)];
  return counts;
}

// The cells, and the far points, are those of a plain count. Far points lie in regions of 128^3 cells with no
// other points, or in unbounded cells.
void check_counts(const Cloud& cloud, const SurveyedScan& scan) {
  const auto counts = counts_of(scan.cells);
  CHECK(counts.size() == scan.cells.size());
  const auto region_of = [](const CellCoord& cell) {
    return CellCoord{cell[0] >> 7, cell[1] >> 7, cell[2] >> 7};
  };
  std::set<CellCoord> regions;
  for (const auto& [cell, points] : counts) regions.insert(region_of(cell));
  std::map<CellCoord, std::uint64_t> expected = counted_plainly(cloud, scan.grid);
  std::uint64_t far_points = 0;
  std::erase_if(expected, [&](const auto& counted) {
    const auto& [cell, points] = counted;
    const bool is_far = scan.grid.is_unbounded(cell) || !regions.contains(region_of(cell));
    if (is_far) far_points += points;
    return is_far;
  });
  CHECK(counts == expected);
  CHECK(scan.far_points == far_points);
  for (const Eigen::Vector3d& p : cloud.positions) {
    if (!p.allFinite()) continue;
    const CellCoord cell = scan.grid.cell_of(p);
    if (!scan.grid.box(cell, cell).contains(p)) {
      FAIL_CHECK("a point lies outside of its cell");
      return;
    }
  }
}

TEST_CASE("a survey counts every finite point in the cell that the final grid gives it") {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const Cloud cloud = random_cloud(4000 + seed);
    INFO("seed " << seed);
    const SurveyedScan scan = survey(cloud, 1 << 30, 1 + 77 * seed, seed % 2 == 0);
    check_counts(cloud, scan);
    CHECK(scan.points == cloud.size());
    const auto dropped = std::count_if(cloud.positions.begin(), cloud.positions.end(),
                                       [](const Eigen::Vector3d& p) { return !p.allFinite(); });
    CHECK(scan.dropped == static_cast<std::uint64_t>(dropped));
  }
}

TEST_CASE("cells merge while they need more memory than allowed, and no point is lost") {
  const Cloud cloud = scattered(3000, 1).scaled(50).joined(lattice(8));
  std::size_t before = 0;
  // OpenVDB's standard tree takes 300 KB for its first cell.
  for (const std::uint64_t memory : {1, 400'000, 450'000, 1'000'000}) {
    const SurveyedScan scan = survey(cloud, memory, 100);
    INFO(memory << " bytes allowed");
    check_counts(cloud, scan);
    CHECK(scan.cells.size() <= std::max<std::uint64_t>(memory / 96, 8));
    CHECK(scan.cells.size() >= before);
    before = scan.cells.size();
  }
  CHECK(before > 8);
}

TEST_CASE("points beyond the grid and in regions with few points are far") {
  Cloud cloud = plane(200).joined(scattered(100, 2).scaled(1e7));
  cloud.positions.push_back({1e30, 0, 0});
  const SurveyedScan scan = survey(cloud);
  check_counts(cloud, scan);
  CHECK(scan.far_points >= 90);
  CHECK(scan.far_points <= 101 + plane(200).size() / 20);
}

TEST_CASE("a survey of nothing, of nothing finite and of one place") {
  CHECK(survey(Cloud{}).cells.empty());
  CHECK(Eigen::AlignedBox3d(survey(Cloud{}).bounds).isEmpty());
  const Cloud unusable = Cloud{{Eigen::Vector3d::Constant(std::nan("")), {0, INFINITY, 0}}, {}};
  CHECK(survey(unusable).cells.empty());
  CHECK(survey(unusable).dropped == 2);
  for (const double at : {0.0, -1e-200, 1e6, 1e30}) {
    const Cloud place = coincident(1000).translated({at, at, at});
    const SurveyedScan scan = survey(place);
    check_counts(place, scan);
    CHECK(scan.cells.size() == 1);
  }
}

SurveyedScan surveyed(std::vector<CountedCell> cells, std::uint64_t far_points, std::uint64_t points) {
  SurveyedScan scan;
  scan.points = points;
  scan.cells = std::move(cells);
  scan.far_points = far_points;
  return scan;
}

TEST_CASE("a single heavy cell is set aside, as are far points, and no cells make no tiles") {
  SurveyedScan scan =
      surveyed({{{0, 0, 0}, 5}, {{1, 0, 0}, 10'000}, {{2, 0, 0}, 5}, {{9, 0, 0}, 5}}, 1, 10'016);
  const TilePlan plan = split_tiles(scan, 12);
  CHECK(counts_of(plan.heavy) == std::map<CellCoord, std::uint64_t>{{{1, 0, 0}, 10'000}});
  CHECK(plan.groups() == 2);
  CHECK(plan.cells.size() == 3);
  SurveyedScan nothing;
  CHECK(split_tiles(nothing, 12).tiles.empty());
}

TEST_CASE("where the count of a cell ended, there is space for tiles of all points of the scan") {
  constexpr std::uint64_t kPoints = 10'000'000'000, kTile = 1'000'000;
  SurveyedScan scan = surveyed({{{0, 0, 0}, kMostCounted}}, 5, kPoints);
  const TilePlan plan = split_tiles(scan, kTile);
  CHECK(plan.group_points(0) == kPoints);
  CHECK(plan.group_points(1) == 5);
  CHECK(plan.most_tiles() == kPoints / kTile + 1);
}

TEST_CASE("the reach is infinite where the scan has no more than k points, finite where it has one more") {
  const TiledScan scan(scattered(16, 1), {});
  const Tiling& tiling = scan.store.tiling();
  CHECK(squared_distance_bound(tiling, 0, 16) == std::numeric_limits<double>::infinity());
  CHECK(squared_distance_bound(tiling, 0, 15) < 100);
}

// ---- The points of a tile

constexpr std::uint64_t kMiB = 1 << 20;

std::uint64_t tile_points(std::uint64_t points, std::uint64_t memory_limit, std::int64_t threads,
                          std::int64_t k = 15, std::int64_t wanted = 0) {
  Config config;
  config.run = {.threads = threads, .memory_limit = memory_limit, .tile_points = wanted};
  config.neighbourhood.k = k;
  return points_per_tile(points, config, workers_of(config.run));
}

TEST_CASE("however many threads work, the tables with entries for each tile fit in memory") {
  for (const std::int64_t threads : {1, 2, 16, 64}) {
    INFO(threads << " threads");
    CHECK(10'000'000 / tile_points(10'000'000, 64 * kMiB, threads) < 4096);
    CHECK(10'000'000 / tile_points(10'000'000, 64 * kMiB, threads, 15, 100) < 4096);
  }
}

TEST_CASE(
    "more points than the memory limit can ever hold are refused, and the limit that is named is enough") {
  const std::uint64_t points = 1'000'000'000;
  CHECK_THROWS_WITH(tile_points(points, 64 * kMiB, 2),
                    "the memory limit of 64 MiB is too small for 1000000000 points; allowed: 143MiB or more");
  CHECK_THROWS_AS(tile_points(points, 142 * kMiB, 2), Error);
  CHECK(tile_points(points, 143 * kMiB, 2) > 0);
}

TEST_CASE("the neighbours in a tile can be numbered in 32 bits, whatever is asked for") {
  for (const std::int64_t k : {15, 128, 1000}) {
    INFO("k = " << k);
    const std::uint64_t most = tile_points(1'000'000'000, 64 * 1024 * kMiB, 2, k, 1'000'000'000);
    CHECK(2 * static_cast<std::uint64_t>(k) * most <= std::uint64_t{1} << 32);
  }
}

// ---- What is stored

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

// ---- The order in a tile

constexpr std::uint64_t kCellPoints = 32;

ScanPoint stored(double x, double y, double z, std::uint64_t id) {
  return {x, y, z, PointId{id}};
}

TEST_CASE("minus zero is at the place of zero") {
  const std::vector<ScanPoint> points = {stored(-0.0, 0, 0.0, 3), stored(0.0, -0.0, -0.0, 1),
                                         stored(0, 0, 0, 2)};
  const std::vector<std::uint32_t> cells = {0, 0, 0};
  const OrderedTile tile = order_tile(points, cells, 1, CellGrid{}, kCellPoints);
  CHECK(tile.order == std::vector<std::uint32_t>{1});
  CHECK(tile.duplicates.size() == 2);
}

TEST_CASE("a crowded cell becomes cells of few points near each other, at any density") {
  Random random(5);
  std::vector<ScanPoint> points;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const double r = std::pow(10, random.uniform(-9, 0)), turn = random.uniform(0, 7);
    points.push_back(stored(r * std::cos(turn), r * std::sin(turn), 0, i));
  }
  const OrderedTile tile =
      order_tile(points, std::vector<std::uint32_t>(points.size(), 0), 1, CellGrid{}, 32);
  REQUIRE(tile.order.size() == points.size());
  std::size_t at = 0, wide = 0;
  for (const Cell& cell : tile.cells) {
    CHECK(cell.points <= 32);
    Eigen::AlignedBox3d box;
    for (std::uint64_t i = 0; i < cell.points; ++i) box.extend(points[tile.order[at++]].position());
    CHECK((box.min() == cell.box.min() && box.max() == cell.box.max()));
    wide += box.diagonal().norm() > 0.5 * std::max(box.min().norm(), box.max().norm());
  }
  CHECK(at == points.size());
  CHECK(tile.cells.size() < points.size() / 8);
  CHECK(wide * 5 < tile.cells.size());
}

}  // namespace
}  // namespace lacuna
