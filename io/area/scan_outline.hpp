// SPDX-License-Identifier: Apache-2.0
// The outline of a scan in plan, by GDAL and GEOS: a function of lacuna_gis.so.
#pragma once

#include "engine/export.hpp"
#include "io/area/plan_polygon.hpp"
#include "io/area/polygonise.hpp"

#include <vector>

namespace lacuna::io {

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
