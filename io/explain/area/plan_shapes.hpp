// SPDX-License-Identifier: Apache-2.0
// The shapes of a raster in plan, by GDAL and GEOS: voids, and the outline of a scan. Functions of
// lacuna_gis.so.
#pragma once

#include "engine/export.hpp"
#include "io/explain/area/plan_raster.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// Cells that GDAL reads row by row.
struct RasterRows {
  std::size_t columns, rows;
  // Writes the values of the cells of a row; 0: no part. It is called for each row several times.
  std::function<void(std::size_t row, std::span<std::uint8_t> values)> row;
};

// A part of the raster whose cells have the same value. Places are in cells.
struct TracedVoid {
  std::uint8_t value;
  PlanPolygon outline;           // along the edges of cells; the outer ring first
  Eigen::Vector2d middle{0, 0};  // of the largest circle that fits in
  double radius = 0;             // of that circle
};

struct TraceTask {
  RasterRows raster;
  std::vector<TracedVoid> voids;
};

// Fills in the voids: cells of one value that share edges. Throws `Error`. Cost: linear in cells; for the
// circles, the logarithm of the corners at some hundred places of each void.
using TraceVoids = void(TraceTask& task);

inline constexpr const char* kTraceVoids = "lacuna_trace_voids";
extern "C" LACUNA_API TraceVoids lacuna_trace_voids;

// Lengths and places are in cells.
struct OutlineTask {
  RasterRows covered;                 // 1: a cell whose middle is nearer to a point than `reach`
  double reach = 0, void_size = 0;    // `void_size`: how wide a bay must be at least
  std::vector<PlanPolygon> polygons;  // the outline
  bool has_bay = false;               // a bay is left out
};

// Fills in the outline: what is covered and what that encloses, without `reach` around it. So it joins points
// that are at most twice `reach` apart. Each of its polygons then takes in what lies between borders that are
// nearer to each other than a tenth of its own width. A bay lies between a polygon and its convex hull, and a
// circle of the void size fits in it. Where its mouth is wide, a larger circle must fit: of a tenth of that
// width, or of a fifth of the mouth. Polygons without a square of the edge 2 `reach` are left out. Throws
// `Error`. Cost: linear in cells; the logarithm of the corners of what is covered, for each corner.
using OutlineScan = void(OutlineTask& task);

inline constexpr const char* kOutlineScan = "lacuna_outline_scan";
extern "C" LACUNA_API OutlineScan lacuna_outline_scan;

}  // namespace lacuna::io
