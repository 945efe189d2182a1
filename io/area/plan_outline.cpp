// SPDX-License-Identifier: Apache-2.0
#include "io/area/plan_outline.hpp"

#include "io/area/scan_outline.hpp"
#include "io/crs/gis_module.hpp"

#include <utility>

namespace lacuna::io {

double bay_of(const Eigen::AlignedBox2d& points) {
  constexpr double kOfShorterSide = 1. / 3;
  return points.sizes().minCoeff() * kOfShorterSide;
}

PlanGrid grid_around(const Eigen::AlignedBox2d& points, double void_size) {
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(void_size);
  return PlanGrid::over({points.min() - margin, points.max() + margin}, void_size);
}

std::vector<PlanPolygon> outline_of_points(const PlanRaster& empty, const PlanGrid& grid, double bay) {
  static auto* const outline =
      reinterpret_cast<OutlineScan*>(load_gis_function(kOutlineScan, "a check without --area"));
  OutlineTask task{.covered = {.columns = grid.columns,
                               .rows = grid.rows,
                               .row =
                                   [&](std::size_t row, std::span<std::uint8_t> values) {
                                     for (std::size_t column = 0; column < values.size(); ++column)
                                       values[column] = empty.has(column, row) ? 0 : 1;
                                   }},
                   .reach = PlanGrid::kCells / 2,
                   .bay = bay / grid.edge()};
  outline(task);
  for (PlanPolygon& polygon : task.polygons)
    for (Ring2& ring : polygon)
      for (Eigen::Vector2d& corner : ring) corner = grid.from_cells(corner);
  return std::move(task.polygons);
}

}  // namespace lacuna::io
