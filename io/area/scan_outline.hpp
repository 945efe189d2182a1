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
  double reach = 0, bay = 0;          // `bay`: how wide a bay is at most that belongs to the scan
  std::vector<PlanPolygon> polygons;  // the outline
};

// Fills in the outline: the morphological closing of what is covered, by a circle of the diameter `bay`,
// without `reach` around it. So what points enclose belongs to it, and bays, as of rivers. Parts that touch
// the outside along much of their border are no bays, but corners of the scan, and are left out. It has no
// polygon where points cover no square of the edge 2 `reach`, or are so sparse that corners are most of the
// closing. Throws `Error`. Cost: linear in cells; the
// logarithm of the corners of what is covered, for each corner.
using OutlineScan = void(OutlineTask& task);

inline constexpr const char* kOutlineScan = "lacuna_outline_scan";
extern "C" LACUNA_API OutlineScan lacuna_outline_scan;

}  // namespace lacuna::io
