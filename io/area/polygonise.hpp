// SPDX-License-Identifier: Apache-2.0
// Polygons of the parts of a raster, by GDAL: functions within lacuna_gis.so.
#pragma once

#include "io/area/plan_polygon.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

class OGRPolygon;

namespace lacuna::io {

// Cells that GDAL reads row by row.
struct RasterRows {
  std::size_t columns, rows;
  // Writes the values of the cells of a row; 0: no part. It is called for each row several times.
  std::function<void(std::size_t row, std::span<std::uint8_t> values)> row;
};

// Calls visit(value, polygon) for each part: cells of one value that share edges. Outlines run along the
// cells. Throws `Error`. Cost: linear in cells.
void polygonise(const RasterRows& raster,
                const std::function<void(std::uint8_t value, const OGRPolygon& polygon)>& visit);

// Returns its rings, the outer one first.
PlanPolygon outline_of(const OGRPolygon& polygon);

}  // namespace lacuna::io
