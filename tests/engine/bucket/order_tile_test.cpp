// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/order_tile.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {
namespace {

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
