// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/order_tile.hpp"

#include "tests/support/clouds.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

constexpr std::uint64_t kCellPoints = 32;

ScanPoint stored(double x, double y, double z, std::uint64_t id) {
  return {x, y, z, PointId{id}};
}

TEST_CASE("points come by cell, then by coordinates; of coincident ones the lowest id stays") {
  const std::vector<ScanPoint> points = {stored(5, 0, 0, 7), stored(1, 0, 0, 4), stored(1, 0, 0, 2),
                                         stored(0, 9, 0, 9), stored(1, 0, 0, 8), stored(0, 3, 0, 1)};
  const std::vector<std::uint32_t> cells = {2, 0, 0, 0, 0, 0};
  const OrderedTile tile = order_tile(points, cells, 3, CellGrid{}, kCellPoints);
  CHECK(tile.order == std::vector<std::uint32_t>{5, 3, 2, 0});
  REQUIRE(tile.cells.size() == 2);  // the one without points is none
  CHECK(tile.cells[0].points == 3);
  CHECK(tile.cells[0].box.min() == Eigen::Vector3d(0, 0, 0));
  CHECK(tile.cells[0].box.max() == Eigen::Vector3d(1, 9, 0));
  CHECK(tile.cells[1].points == 1);
  REQUIRE(tile.duplicates.size() == 2);
  std::map<std::uint64_t, LocalIndex> of;
  for (const Duplicate& d : tile.duplicates) of[value(d.id)] = d.of;
  CHECK(of == std::map<std::uint64_t, LocalIndex>{{4, 2}, {8, 2}});
}

TEST_CASE("minus zero is at the place of zero") {
  const std::vector<ScanPoint> points = {stored(-0.0, 0, 0.0, 3), stored(0.0, -0.0, -0.0, 1),
                                         stored(0, 0, 0, 2)};
  const std::vector<std::uint32_t> cells = {0, 0, 0};
  const OrderedTile tile = order_tile(points, cells, 1, CellGrid{}, kCellPoints);
  CHECK(tile.order == std::vector<std::uint32_t>{1});
  CHECK(tile.duplicates.size() == 2);
}

TEST_CASE(
    "every point is kept or a duplicate of one kept at its very place, and input order does not matter") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    std::vector<ScanPoint> points;
    const std::int64_t n = random.whole(1, 500);
    for (std::int64_t i = 0; i < n; ++i) {
      const double x = double(random.whole(-3, 3)), y = random.chance(0.5) ? 0.0 : -0.0;
      points.push_back(stored(x, y, double(random.whole(0, 4)), std::uint64_t(i)));
    }
    const auto ordered = [](std::vector<ScanPoint> in) {
      std::vector<std::uint32_t> cells;
      for (const ScanPoint& p : in) cells.push_back(p.x < 0 ? 0 : 1);
      const OrderedTile tile = order_tile(in, cells, 2, CellGrid{}, kCellPoints);
      std::vector<PointId> kept, copies;
      for (const std::uint32_t i : tile.order) kept.push_back(in[i].id);
      for (const Duplicate& d : tile.duplicates) {
        const ScanPoint& of = in[tile.order[d.of]];
        const auto at = std::find_if(in.begin(), in.end(), [&](const ScanPoint& p) { return p.id == d.id; });
        CHECK((at->x == of.x && at->y == of.y && at->z == of.z && of.id < d.id));
        copies.push_back(d.id);
      }
      std::sort(copies.begin(), copies.end());
      CHECK(kept.size() + copies.size() == in.size());
      return std::pair(kept, copies);
    };
    const auto expected = ordered(points);
    std::reverse(points.begin(), points.end());
    CHECK(ordered(points) == expected);
  }
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
