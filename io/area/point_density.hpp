// SPDX-License-Identifier: Apache-2.0
// How dense the points of an area are.
#pragma once

#include "io/area/plan_raster.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna::io {

// Counts points in squares of `edge` x `edge` cells.
class PointDensity {
 public:
  PointDensity(std::size_t edge, const PlanGrid& grid)
      : edge_(edge), columns_(grid.columns / edge + 1), points_(columns_ * (grid.rows / edge + 1)) {}

  static std::uint64_t bytes(std::size_t edge, const PlanGrid& grid) {
    return (grid.columns / edge + 1) * (grid.rows / edge + 1) * sizeof(std::uint32_t);
  }

  void add(std::size_t column, std::size_t row) { ++points_[row / edge_ * columns_ + column / edge_]; }

  // Returns the spacing of the points around an outline: of the squares with points, at most two squares away
  // from it, that it does not pass. NaN without such squares. It is in cells, as is the outline; `inside` is
  // the area.
  double spacing_around(const PlanPolygon& outline, const PlanRaster& inside) const;

 private:
  std::size_t edge_, columns_;
  std::vector<std::uint32_t> points_;
};

}  // namespace lacuna::io
