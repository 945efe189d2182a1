// SPDX-License-Identifier: Apache-2.0
// From places to cells.
#include "engine/bucket/bucket_scan.hpp"

#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

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
    for (int i = 0; i < 1000; ++i)
      positions.emplace_back(random.uniform(-1e4, 1e4), random.uniform(-1, 1), random.uniform(-1e10, 1e10));
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

}  // namespace
}  // namespace lacuna
