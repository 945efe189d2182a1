// SPDX-License-Identifier: Apache-2.0
// The raster of an area against plain loops over its cells.
#include "io/explain/area/plan_raster.hpp"

#include "io/explain/area/empty_places.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

using Random = std::mt19937;

double draw(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

Eigen::Vector2d middle(std::size_t column, std::size_t row) {
  return {static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5};
}

PlanGrid grid_of(std::size_t columns, std::size_t rows) {
  return {.size = PlanGrid::kCells, .columns = columns, .rows = rows};
}

// A star of random radii with a square hole, partly beyond the grid.
PlanPolygon star(Random& random, double extent) {
  const Eigen::Vector2d centre(draw(random, 0, extent), draw(random, 0, extent));
  Ring2 outer;
  for (int i = 0; i < 17; ++i) {
    const double angle = 2 * std::numbers::pi * i / 17, radius = draw(random, 4, extent);
    outer.emplace_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  Ring2 inner;
  for (const auto& [x, y] : {std::pair(-2, -2), {2, -2}, {2, 2}, {-2, 2}})
    inner.emplace_back(centre + Eigen::Vector2d(x, y));
  return {outer, inner};
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

TEST_CASE("the cells of a polygon are those whose middles are inside, and several polygons add up") {
  Random random(1);
  for (std::uint64_t drawn = 0; drawn < draws(20); ++drawn) {
    const PlanGrid grid = grid_of(150, 70);
    const std::vector<PlanPolygon> polygons{star(random, 80), star(random, 80)};
    const PlanRaster raster = rasterise(polygons, grid);
    std::uint64_t count = 0;
    for (std::size_t row = 0; row < grid.rows; ++row) {
      for (std::size_t column = 0; column < grid.columns; ++column) {
        const Eigen::Vector2d place = middle(column, row);
        const bool expected = is_inside(polygons[0], place) || is_inside(polygons[1], place);
        REQUIRE(raster.has(column, row) == expected);
        count += expected;
      }
    }
    CHECK(raster.count() == count);
    CHECK(count_bits(raster.row(3), 0, 150) ==
          count_bits(raster.row(3), 0, 77) + count_bits(raster.row(3), 77, 150));
  }
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

TEST_CASE("a point clears the middles that are nearer than the radius, and no other") {
  Random random(2);
  const PlanGrid grid = grid_of(131, 40);
  for (std::uint64_t drawn = 0; drawn < draws(50); ++drawn) {
    PlanRaster raster(grid);
    raster.fill();
    const Eigen::Vector2d point(draw(random, -8, 139), draw(random, -8, 48));
    const double radius = draw(random, 0.3, 9);
    clear_disc(point, radius, raster);
    for (std::size_t row = 0; row < grid.rows; ++row) {
      for (std::size_t column = 0; column < grid.columns; ++column)
        REQUIRE(raster.has(column, row) == ((middle(column, row) - point).norm() >= radius));
    }
    CHECK_FALSE(has_in_disc(point, radius, raster));
    const auto beyond = static_cast<std::size_t>(std::clamp(point.x() + radius + 2, 0., 130.));
    const auto row = static_cast<std::size_t>(std::clamp(point.y(), 0., 39.));
    CHECK(has_in_disc(middle(beyond, row), 1, raster) == raster.has(beyond, row));
  }
}

TEST_CASE("a grown row has the cells within the radius of a set one") {
  Random random(3);
  const PlanGrid grid = grid_of(200, 30);
  PlanRaster raster(grid);
  for (int i = 0; i < 40; ++i) {
    const auto column = static_cast<std::size_t>(draw(random, 0, 200));
    raster.set(static_cast<std::size_t>(draw(random, 0, 30)), column, column + 1);
  }
  const auto copy = [&](std::size_t row, std::span<std::uint64_t> cells) {
    std::copy(raster.row(row).begin(), raster.row(row).end(), cells.begin());
  };
  for (std::size_t row = 0; row < grid.rows; ++row) {
    std::vector<std::uint64_t> grown(raster.row(row).size());
    grow_row(grid, copy, row, 5, grown);
    for (std::size_t column = 0; column < grid.columns; ++column) {
      bool expected = false;
      for (std::size_t r = 0; r < grid.rows; ++r) {
        for (std::size_t c = 0; c < grid.columns; ++c)
          expected |= raster.has(c, r) && (middle(c, r) - middle(column, row)).norm() <= 5;
      }
      REQUIRE(count_bits(grown, column, column + 1) == expected);
    }
  }
}

TEST_CASE("the convex hull is the same in any order, and has every point on its left") {
  Random random(4);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 10'000; ++i)
    points.emplace_back(std::round(draw(random, 0, 300)), std::round(draw(random, 0, 50)));
  const auto hull_of = [&] {
    ConvexHull hull;
    for (const Eigen::Vector2d& point : points) hull.add(point);
    return hull.corners();
  };
  const Ring2 hull = hull_of();
  std::shuffle(points.begin(), points.end(), random);
  CHECK(hull == hull_of());
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d along = hull[(i + 1) % hull.size()] - hull[i];
    for (const Eigen::Vector2d& point : points) {
      const Eigen::Vector2d to = point - hull[i];
      REQUIRE(along.x() * to.y() - along.y() * to.x() >= 0);
    }
  }
}

TEST_CASE("few points have a hull of few corners") {
  ConvexHull hull;
  CHECK(hull.corners().empty());
  hull.add({1, 1});
  hull.add({1, 1});
  CHECK(hull.corners().size() == 1);
  hull.add({3, 3});
  hull.add({2, 2});
  CHECK(hull.corners().size() == 2);
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
