// SPDX-License-Identifier: Apache-2.0
// survey, split and reach: from points to cells, tiles, and how far neighbours may be.
#include "engine/bucket/split.hpp"
#include "engine/model/distance_bound.hpp"
#include "engine/survey/survey.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/memory_scan.hpp"
#include "tests/support/tile.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna {
namespace {

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

TilePlan plan_of(const Cloud& cloud, std::uint64_t tile_points) {
  SurveyedScan scan = survey(cloud);
  return split_tiles(scan, tile_points);
}

// The index of a cloud's distinct points, and the points of each of its cells.
struct Index {
  Tiling tiling;
  std::vector<std::vector<Eigen::Vector3d>> points;
};

Index index_of(const Cloud& cloud, std::int64_t tile_points) {
  const TiledScan scan(cloud, tiled({}, tile_points));
  Index index{scan.store.tiling(), {}};
  for (std::uint32_t c = 0; c < index.tiling.cells.size(); ++c) {
    auto& points = index.points.emplace_back();
    for (const ScanPoint& p : scan.store.cell(c)) points.push_back(p.position());
  }
  return index;
}

Tiling tiling_of(const Cloud& cloud, std::int64_t tile_points) {
  return index_of(cloud, tile_points).tiling;
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

TEST_CASE("surveys of parts of a scan add up to the survey of the scan, in whatever memory each was made") {
  const Cloud cloud = scattered(20'000, 6).with_outliers(40, 30, 2).with_unusable(10, 1).shuffled(3);
  for (const std::size_t parts : {1, 2, 7}) {
    for (const std::uint64_t memory : {std::uint64_t{1} << 30, std::uint64_t{1} << 20}) {
      const ScratchFolder folder;
      Survey merged(1 << 30, cloud.size(), folder / "merged");
      MemoryScan scan(cloud);
      PointBatch first;
      scan.next(first);
      for (std::size_t part = 0; part < parts; ++part) {
        Survey survey(part % 2 == 0 ? memory : 1 << 30, cloud.size(), folder / "cells");
        survey.choose_size(first);
        MemoryScan own(cloud);
        PointBatch points;
        for (std::size_t batch = 0; own.next(points); ++batch) {
          points.first = PointId{value(points.first) % 1000};  // ids of a part count from 0
          if (batch * parts / 21 == part) survey.add(points);
        }
        merged.add(survey.counts());
      }
      const SurveyedScan found = merged.finish();
      INFO(parts << " parts, " << memory << " bytes");
      CHECK(found.points == cloud.size());
      CHECK(found.dropped == survey(cloud).dropped);
      CHECK(Eigen::AlignedBox3d(found.bounds).isApprox(survey(cloud).bounds, 0));
      check_counts(cloud, found);
    }
  }
}

TEST_CASE("cells hold about sixteen points on average, save where they cannot merge") {
  const SurveyedScan scan = survey(scattered(20'000, 3).scaled(10));
  CHECK(scan.cells.size() * Survey::kPointsPerCell <= 20'000);
  CHECK(scan.cells.size() * Survey::kPointsPerCell >= 20'000 / 5);
}

TEST_CASE("cells that are finer than the spacing merge in memory") {
  Cloud strip;  // each batch shows a small part of it
  for (int row = 0; row < 8'000; ++row)
    for (int i = 0; i < 20; ++i) strip.positions.emplace_back(i, row, 0);
  Survey survey(400'000, strip.size(), "no folder/cells");  // a file there would be an error
  MemoryScan scan(strip, 1000);
  for (PointBatch points; scan.next(points);) survey.add(points);
  check_counts(strip, survey.finish());
}

TEST_CASE("outliers far from all else do not make the cells of a surface larger") {
  const Cloud surface = plane(200);
  const auto cells_of_surface = [&](const SurveyedScan& scan) {
    std::set<CellCoord> cells;
    for (const Eigen::Vector3d& p : surface.positions) cells.insert(scan.grid.cell_of(p));
    return cells.size();
  };
  const std::size_t alone = cells_of_surface(survey(surface));
  for (const int outliers : {500, 5'000}) {  // 1 and 11 in a hundred
    for (const std::size_t batch : {1'000, 100'000}) {
      Cloud cloud = surface.joined(scattered(outliers, 2).scaled(1e7));
      if (batch > 1'000) cloud = cloud.shuffled(3);
      const SurveyedScan scan = survey(cloud, 1 << 30, batch);
      check_counts(cloud, scan);
      INFO(outliers << " outliers, batches of " << batch);
      CHECK(cells_of_surface(scan) * 20 >= alone);  // twice a doubling
    }
  }
}

TEST_CASE("a scan has the same cells anywhere on Earth, down to a spacing of a millimetre") {
  const Cloud scan = plane(200).scaled(1e-3);
  const std::size_t cells = survey(scan).cells.size();
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(5.4e6, 5.4e6, 300), Eigen::Vector3d(500'000, 5.4e6, 300),
        Eigen::Vector3d(-2.7e6, -4.3e6, 3.85e6), Eigen::Vector3d(1e9, 0, -1e9)}) {
    const Cloud there = scan.translated(place);
    const SurveyedScan surveyed = survey(there);
    check_counts(there, surveyed);
    INFO(place.transpose());
    CHECK(surveyed.cells.size() > cells / 2);
    CHECK(surveyed.cells.size() < cells * 2);
    std::uint32_t most = 0;
    for (const CountedCell& cell : surveyed.cells) most = std::max(most, cell.points);
    CHECK(most < 200);
  }
}

TEST_CASE("points beyond the grid and in regions with few points are far") {
  Cloud cloud = plane(200).joined(scattered(100, 2).scaled(1e7));
  cloud.positions.push_back({1e30, 0, 0});
  const SurveyedScan scan = survey(cloud);
  check_counts(cloud, scan);
  CHECK(scan.far_points >= 90);
  CHECK(scan.far_points <= 101 + plane(200).size() / 20);
}

TEST_CASE(
    "far outliers more than fit in the memory of the survey do not make the cells of a surface larger") {
  const Cloud cloud = plane(200).joined(scattered(10'000, 2).scaled(1e7)).shuffled(3);
  const SurveyedScan scan = survey(cloud, 600'000);
  check_counts(cloud, scan);
  CHECK(scan.far_points >= 9'900);
  CHECK(scan.cells.size() >= plane(200).size() / 400);
}

TEST_CASE("the index of the cells fits in the memory of the survey, wherever they are") {
  Cloud clusters;
  for (int i = 0; i < 600; ++i) {
    const Eigen::Vector3d centre(i % 10 * 1e4, i / 10 % 10 * 1e4, i / 100 * 1e4);
    clusters = clusters.joined(scattered(60, static_cast<std::uint64_t>(i)).translated(centre));
  }
  constexpr std::uint64_t kMemory = 4'000'000;
  const SurveyedScan scan = survey(clusters, kMemory, 1000);
  check_counts(clusters, scan);
  std::set<CellCoord> lower, upper;  // nodes of the tree, of 33 and 270 KB
  for (const CountedCell& cell : scan.cells) {
    lower.insert({cell.coord[0] >> 7, cell.coord[1] >> 7, cell.coord[2] >> 7});
    upper.insert({cell.coord[0] >> 12, cell.coord[1] >> 12, cell.coord[2] >> 12});
  }
  CHECK(lower.size() * 33'000 + upper.size() * 270'000 < kMemory);
  CHECK(scan.cells.size() + scan.far_points > 100);
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

TEST_CASE("planned tiles hold every cell once, in order, and no more points than allowed") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Cloud cloud = random_cloud(5000 + seed);
    const SurveyedScan scan = survey(cloud);
    const auto before = counts_of(scan.cells);
    for (const std::uint64_t limit : {1, 20, 300, 1'000'000}) {
      const TilePlan plan = plan_of(cloud, limit);
      INFO("seed " << seed << ", " << limit << " points a tile");
      std::vector<CountedCell> all = plan.cells;
      all.insert(all.end(), plan.heavy.begin(), plan.heavy.end());
      CHECK(counts_of(all) == before);
      CHECK(all.size() == before.size());
      std::uint64_t most_tiles = plan.tiles.size();
      for (const CountedCell& cell : plan.heavy) {
        CHECK(cell.points > limit);
        most_tiles += (cell.points + limit - 1) / limit;
      }
      CHECK(plan.far_points == scan.far_points);
      most_tiles += (plan.far_points + limit - 1) / limit;
      CHECK(plan.most_tiles() == most_tiles);
      std::uint32_t next_cell = 0;
      std::uint64_t next_row = 0;
      for (const Tile& tile : plan.tiles) {
        CHECK(tile.first_cell == next_cell);
        REQUIRE(tile.last_cell > tile.first_cell);
        std::uint64_t points = 0;
        for (std::uint32_t c = tile.first_cell; c < tile.last_cell; ++c) points += plan.cells[c].points;
        CHECK(points == tile.raw);
        CHECK(points <= limit);
        CHECK(value(tile.first_row) % kRowAlignment == 0);
        CHECK(value(tile.first_row) >= next_row);
        next_row = value(tile.first_row) + tile.raw;
        next_cell = tile.last_cell;
      }
      CHECK(next_cell == plan.cells.size());
    }
  }
}

TEST_CASE("the tree over the cells halves down to few cells, its boxes tight") {
  for (const Cloud& cloud : {hard_cloud(1), plane(60), random_cloud(1).joined(coincident(3000))}) {
    const Tiling tiling = tiling_of(cloud, 400);
    for (const CellNode& node : tiling.nodes) {
      Eigen::AlignedBox3d box;
      std::uint64_t points = 0;
      for (std::uint32_t c = node.first; c < node.last; ++c) {
        box.extend(tiling.cells[c].box);
        points += tiling.cells[c].points;
      }
      CHECK((box.min() == node.box.min() && box.max() == node.box.max() && points == node.points));
      const bool spans_tiles = tiling.tile_of_cell(node.first) != tiling.tile_of_cell(node.last - 1);
      if (node.left == 0) {
        CHECK(node.last - node.first <= Tiling::kLeafCells);
      } else {
        const CellNode &left = tiling.nodes[node.left], &right = tiling.nodes[node.right];
        CHECK((left.first == node.first && left.last == right.first && right.last == node.last));
        if (spans_tiles) CHECK(tiling.tile_of_cell(left.last - 1) != tiling.tile_of_cell(right.first));
      }
    }
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

TEST_CASE("the reach of a cell is no less than the distance to the k-th neighbour of any of its points") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Cloud cloud = random_cloud(6000 + seed);
    if (seed == 1) cloud = hard_cloud(2);
    Cloud distinct;
    for (const PointId id : distinct_ids(cloud)) distinct.positions.push_back(cloud.positions[value(id)]);
    if (distinct.size() == 0) continue;
    const auto [tiling, points] = index_of(distinct, 200);
    for (const std::size_t k : {1, 7, 40}) {
      std::vector<double> reach(tiling.cells.size());
      for (std::uint32_t c = 0; c < tiling.cells.size(); ++c) reach[c] = squared_distance_bound(tiling, c, k);
      std::size_t too_short = 0;
      for (std::size_t i = 0; i < distinct.size(); i += 1 + distinct.size() / 300) {
        const Eigen::Vector3d& p = distinct.positions[i];
        std::uint32_t cell = 0;
        while (std::find(points[cell].begin(), points[cell].end(), p) == points[cell].end()) ++cell;
        std::vector<double> others;
        for (std::size_t j = 0; j < distinct.size(); ++j)
          if (j != i) others.push_back(squared_distance(p, distinct.positions[j]));
        const double bound = reach[cell];
        if (others.size() < k) {
          too_short += bound != std::numeric_limits<double>::infinity();
        } else {
          std::nth_element(others.begin(), others.begin() + std::ptrdiff_t(k) - 1, others.end());
          too_short += bound < others[k - 1];
        }
      }
      INFO("seed " << seed << ", k " << k);
      CHECK(too_short == 0);
    }
  }
}

TEST_CASE("the reach is infinite where the scan has no more than k points, finite where it has one more") {
  const Tiling tiling = tiling_of(scattered(16, 1), 1'000'000);
  CHECK(squared_distance_bound(tiling, 0, 16) == std::numeric_limits<double>::infinity());
  CHECK(squared_distance_bound(tiling, 0, 15) < 100);
}

TEST_CASE("the reach in an even plane is a few spacings") {
  const Tiling tiling = tiling_of(plane(100), 1'000'000);
  for (std::uint32_t c = 0; c < tiling.cells.size(); ++c)
    if (std::sqrt(squared_distance_bound(tiling, c, 15)) > 30) FAIL_CHECK("a reach of more than 30 spacings");
}

TEST_CASE("cells near a box are those of a search through all") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Cloud cloud = random_cloud(7000 + seed);
    const Tiling tiling = tiling_of(cloud, 100);
    const auto cells = static_cast<std::uint32_t>(tiling.cells.size());
    if (cells == 0) continue;
    Random random(seed);
    for (int query = 0; query < 50; ++query) {
      const auto pick = [&] { return static_cast<std::uint32_t>(random.whole(0, cells - 1)); };
      const Eigen::AlignedBox3d box = tiling.cells[pick()].box;
      const double radius =
          Eigen::AlignedBox3d(tiling.cells[pick()].box).diagonal().norm() * random.uniform(0, 5);
      std::uint32_t skip_first = pick(), skip_last = pick();
      if (skip_first > skip_last || random.chance(0.3)) skip_first = skip_last = 0;
      std::vector<std::uint32_t> expected, found;
      for (std::uint32_t c = 0; c < cells; ++c) {
        const bool near = min_squared_distance(box, tiling.cells[c].box) <= radius * radius;
        if (near && !(c >= skip_first && c < skip_last)) expected.push_back(c);
      }
      const auto all = [&](std::uint32_t c) {
        found.push_back(c);
        return true;
      };
      for_each_cell_near(tiling, box, radius * radius, skip_first, skip_last, all);
      CHECK(found == expected);
      int visits = 0;
      for_each_cell_near(tiling, box, radius * radius, skip_first, skip_last, [&](std::uint32_t) {
        ++visits;
        return false;
      });
      CHECK(visits == (expected.empty() ? 0 : 1));
    }
  }
}

TEST_CASE("points beyond the end of the grid have a finite reach") {
  Cloud cloud = scattered(300, 4);
  cloud.positions.push_back({1e30, 0, 0});
  cloud.positions.push_back({1e29, 0, 0});
  const Tiling tiling = tiling_of(cloud, 50);
  for (std::uint32_t c = 0; c < tiling.cells.size(); ++c) {
    const double reach = squared_distance_bound(tiling, c, 5);
    CHECK_FALSE(std::isnan(reach));
    CHECK(reach > 0);
  }
}

}  // namespace
}  // namespace lacuna
