// SPDX-License-Identifier: Apache-2.0
// The raster of an area. tests/program/area_reference.py has the definition, cell by cell.
#include "io/explain/area/plan_raster.hpp"

#include "io/explain/area/empty_places.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

Eigen::Vector2d middle(std::size_t column, std::size_t row) {
  return {static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5};
}

PlanGrid grid_of(std::size_t columns, std::size_t rows) {
  return {.size = PlanGrid::kCells, .columns = columns, .rows = rows};
}

// Counts the edges that a ray to the east crosses.
bool is_inside(const PlanPolygon& polygon, const Eigen::Vector2d& place) {
  bool inside = false;
  for (const Ring2& ring : polygon) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() <= place.y()) == (b.y() <= place.y())) continue;
      inside ^= a.x() + (place.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > place.x();
    }
  }
  return inside;
}

TEST_CASE("a polygon that crosses rows very often has the same cells, in rows one after the other") {
  const PlanGrid grid = grid_of(400, 1500);
  Ring2 comb;  // up and down within each two columns
  for (int i = 0; i < 100; ++i) {
    comb.emplace_back(4 * i, 0);
    comb.emplace_back(4 * i + 1, 1500);
    comb.emplace_back(4 * i + 2, 1500);
    comb.emplace_back(4 * i + 3, 2);
  }
  const PlanPolygon polygon{comb};
  std::size_t last = 0;
  std::vector<std::uint64_t> cells(grid.rows);
  for_each_run(polygon, Frame::kCells, grid, [&](std::size_t row, std::size_t from, std::size_t to) {
    REQUIRE(row >= last);
    last = row;
    cells[row] += to - from;
  });
  for (std::size_t row = 0; row < grid.rows; row += 7) {
    std::uint64_t expected = 0;
    for (std::size_t column = 0; column < grid.columns; ++column)
      expected += is_inside(polygon, middle(column, row));
    REQUIRE(cells[row] == expected);
  }
}

TEST_CASE("squares of the table are whole multiples of their edge, and sum up their cells") {
  PlanGrid grid = grid_of(30, 20);
  grid.first = {-5, 13};  // from -5 to 25, and from 13 to 33
  PlanRaster inside(grid);
  for (std::size_t row = 0; row < grid.rows; ++row) inside.set(row, 0, 28);
  AreaTiles tiles(20, grid);
  tiles.add_area(inside);
  tiles.add_void_cells(2, 3, 8);
  tiles.add_point(6, 6);
  tiles.add_void(6, 7);
  const std::vector<AreaTile> all = tiles.with_area();
  REQUIRE(all.size() == 6);
  CHECK(all[0].corner == Eigen::Vector2d(-20, 0));
  CHECK(all[0].area == 5 * 7);
  CHECK(all[0].voids_area == 2);
  CHECK(all[1].corner == Eigen::Vector2d(0, 0));
  CHECK(all[1].voids_area == 3);
  CHECK(all[1].points == 1);
  CHECK(all[4].corner == Eigen::Vector2d(0, 20));
  CHECK(all[4].voids == 1);
  CHECK(all[5].area == 3 * 13);
  CHECK(AreaTiles(0, grid).with_area().empty());
}

TEST_CASE("the spacing around an outline is of the points near it") {
  const PlanGrid grid = grid_of(200, 200);
  PlanRaster inside(grid);
  inside.fill();
  PointDensity density(grid);
  for (std::size_t row = 0; row < grid.rows; row += 2) {
    for (std::size_t column = 0; column < grid.columns; column += 2) {
      const bool is_empty = row >= 80 && row < 120 && column >= 80 && column < 120;
      const bool is_far = row < 48 || column < 48;  // denser there
      for (int i = 0; i < (is_far ? 5 : is_empty ? 0 : 1); ++i) density.add(column, row);
    }
  }
  const Ring2 outline{{80, 80}, {80, 120}, {120, 120}, {120, 80}};
  CHECK(density.spacing_around({outline}, inside) == Approx(2));
  CHECK(std::isnan(PointDensity(grid).spacing_around({outline}, inside)));
}

}  // namespace
}  // namespace lacuna::io
