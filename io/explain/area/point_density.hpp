// SPDX-License-Identifier: Apache-2.0
// How dense the points of an area are.
#pragma once

#include "io/explain/area/plan_raster.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna::io {

// Counts points in squares of kEdge x kEdge cells.
class PointDensity {
 public:
  static constexpr std::size_t kEdge = 8;

  explicit PointDensity(const PlanGrid& grid)
      : columns_(grid.columns / kEdge + 1), points_(columns_ * (grid.rows / kEdge + 1)) {}

  void add(std::size_t column, std::size_t row) { ++points_[row / kEdge * columns_ + column / kEdge]; }

  // Returns the spacing of the points in the squares that have any; NaN without points. It is in cells;
  // `inside` is the area.
  double spacing(const PlanRaster& inside) const;

  // Returns the spacing of the points around an outline. Squares with points count that are at most two
  // squares away from it, and that it does not pass. NaN without such squares. It is in cells, as is the
  // outline; `inside` is the area.
  double spacing_around(const PlanPolygon& outline, const PlanRaster& inside) const;

 private:
  std::uint64_t area_of(std::size_t square, const PlanRaster& inside) const;  // in cells

  std::size_t columns_;
  std::vector<std::uint32_t> points_;
};

}  // namespace lacuna::io
