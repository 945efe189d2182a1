// SPDX-License-Identifier: Apache-2.0
#include "io/write/results/gis_results.hpp"
#include "tests/support/test.hpp"

namespace lacuna::io {
namespace {

// Cells with an edge of 1, of which the north-west corner is at 0 `rows`.
CoverageGrid grid(std::size_t columns, std::size_t rows) {
  CoverageGrid grid{.corner = {0, static_cast<double>(rows)}, .edge = 1, .columns = columns, .rows = rows};
  grid.points.resize(grid.size());
  grid.holes.resize(grid.size());
  return grid;
}

TEST_CASE("a polygon covers the share of each cell that lies within it") {
  CoverageGrid three = grid(3, 2);
  add_polygon({Ring2{{0.5, 0.5}, {2.25, 0.5}, {2.25, 2}, {0.5, 2}}}, three);
  CHECK(three.holes == std::vector<float>{0.5F, 1, 0.25F, 0.25F, 0.5F, 0.125F});

  CoverageGrid triangle = grid(1, 1);
  add_polygon({Ring2{{0, 0}, {1, 0}, {0, 1}}}, triangle);
  CHECK(triangle.holes[0] == Approx(0.5).margin(1e-6));

  CoverageGrid with_a_notch = grid(4, 1);  // not convex
  add_polygon({Ring2{{0, 0}, {4, 0}, {4, 1}, {3, 1}, {3, 0.5}, {1, 0.5}, {1, 1}, {0, 1}}}, with_a_notch);
  CHECK(with_a_notch.holes == std::vector<float>{1, 0.5F, 0.5F, 1});
}

TEST_CASE("what lies within an inner ring is not covered") {
  CoverageGrid four = grid(4, 1);
  const Ring2 hole = {{0, 0}, {4, 0}, {4, 1}, {0, 1}},
              island = {{1, 0.25}, {1, 0.75}, {2.5, 0.75}, {2.5, 0.25}};
  add_polygon({hole, island}, four);
  CHECK(four.holes == std::vector<float>{1, 0.5F, 0.75F, 1});
}

TEST_CASE("a polygon that reaches beyond the grid covers what is in it") {
  CoverageGrid two = grid(2, 1);
  add_polygon({Ring2{{-5, -5}, {1.5, -5}, {1.5, 7}, {-5, 7}}}, two);
  CHECK(two.holes == std::vector<float>{1, 0.5F});
  add_polygon({Ring2{{10, 10}, {12, 10}, {11, 12}}}, two);
  CHECK(two.holes == std::vector<float>{1, 0.5F});
}

TEST_CASE("a polygon seen from its edge covers nothing") {
  CoverageGrid one = grid(1, 1);
  add_polygon({Ring2{{0.2, 0.3}, {0.8, 0.3}, {0.8, 0.3}, {0.2, 0.3}}}, one);
  CHECK(one.holes[0] == 0);
}

}  // namespace
}  // namespace lacuna::io
