// SPDX-License-Identifier: Apache-2.0
// From places to cells.
#include "engine/bucket/cell_index.hpp"

#include "tests/support/clouds.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <catch2/catch.hpp>

namespace lacuna {
namespace {

std::int32_t cell_along_axis(double x, double origin, const CellGrid& grid) {
  const double index = std::floor(std::ldexp(x, -grid.finest)) - origin;
  const double last = CellGrid::kLast;
  return static_cast<std::int32_t>(std::clamp(index, -last, last)) >> grid.shift;
}

TEST_CASE("the cells of many positions are those of each, rounded down, whatever their size") {
  Random random(1);
  const std::vector<double> hard = {
      0.0, -0.0, 1e-320, -1e-320, 1, -1, std::nextafter(1, 0), std::nextafter(-1, -2),
      1e9, -1e9, 1e300,  -1e300};
  for (const CellGrid grid : {CellGrid{}, CellGrid{-7, 0}, CellGrid{3, 2}, CellGrid{-500, 30},
                              CellGrid{-10, 1, {5.4e9, -1e12, 3}}}) {
    std::vector<Eigen::Vector3d> positions;
    for (const double x : hard) positions.emplace_back(x, -x, std::ldexp(x, grid.finest));
    for (int i = 0; i < 1000; ++i) {
      positions.emplace_back(random.uniform(-1e4, 1e4), random.uniform(-1, 1), random.uniform(-1e10, 1e10));
    }
    std::vector<CellCoord> cells(positions.size());
    grid.cells_of(positions, cells);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis)
        wrong += cells[i][axis] != cell_along_axis(positions[i][axis], grid.origin[std::size_t(axis)], grid);
      wrong += cells[i] != grid.cell_of(positions[i]);
    }
    INFO("finest " << grid.finest << ", shift " << grid.shift);
    CHECK(wrong == 0);
  }
}

TEST_CASE("every counted cell is found by a position in it, and no other") {
  Random random(2);
  std::vector<CountedCell> counted;
  std::map<CellCoord, std::uint32_t> numbers;
  const auto count = [&](const CellCoord& cell) {
    if (numbers.emplace(cell, static_cast<std::uint32_t>(numbers.size())).second)
      counted.push_back({cell, 1});
  };
  constexpr std::int32_t kLast = CellGrid::kLast;
  for (const std::int32_t x : {-kLast, -kLast + 1, -1, 0, 7, 8, kLast - 1, kLast}) {
    for (const std::int32_t y : {-kLast, 0, kLast}) count({x, y, 5});
  }
  for (int i = 0; i < 3000; ++i) {  // mostly alone in their leaves: the table grows
    const auto at = [&] { return static_cast<std::int32_t>(random.whole(-500, 500)); };
    count({at(), at(), at()});
  }
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::uint32_t> expected;
  const auto ask = [&](const CellCoord& cell) {
    positions.emplace_back(cell[0] + 0.25, cell[1] + 0.5, cell[2]);
    const auto found = numbers.find(cell);
    expected.push_back(found == numbers.end() ? CellIndex::kNoCell : found->second);
  };
  for (const CountedCell& cell : counted) {
    ask(cell.coord);
    ask({cell.coord[0], cell.coord[1], cell.coord[2] + 1});  // mostly the same leaf, without points
    ask({cell.coord[1], cell.coord[2], cell.coord[0]});      // mostly another leaf
  }
  std::vector<std::uint32_t> cells(positions.size());
  CellIndex(CellGrid{}, std::span(counted).first(1000), std::span(counted).subspan(1000))
      .find(positions, cells);
  CHECK(cells == expected);
  CHECK(std::count(cells.begin(), cells.end(), CellIndex::kNoCell) > 3000);
}

TEST_CASE("far cells have no number, and the others keep theirs") {
  const std::vector<CountedCell> counted = {{{1, 2, 3}, 5}, {{70, 0, 0}, 1, true}, {{-9, 0, 4}, 2}};
  const std::vector<Eigen::Vector3d> positions = {{1.5, 2.5, 3.5}, {70.5, 0.5, 0.5}, {-8.5, 0, 4}};
  std::vector<std::uint32_t> cells(3);
  CellIndex(CellGrid{}, counted).find(positions, cells);
  CHECK(cells == std::vector<std::uint32_t>{0, CellIndex::kNoCell, 2});
}

TEST_CASE("an index of nothing finds nothing") {
  const std::vector<Eigen::Vector3d> positions = {{0, 0, 0}, {NAN, 0, 0}, {-INFINITY, 0, 0}};
  std::vector<std::uint32_t> cells(3);
  CellIndex(CellGrid{}, {}).find(positions, cells);
  CHECK(cells == std::vector<std::uint32_t>(3, CellIndex::kNoCell));
}

}  // namespace
}  // namespace lacuna
