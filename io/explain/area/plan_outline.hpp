// SPDX-License-Identifier: Apache-2.0
// The outline of the points of a scan, seen from above.
#pragma once

#include "engine/run/progress.hpp"
#include "io/explain/area/plan_polygon.hpp"
#include "io/read/scan/scan_files.hpp"

#include <vector>

namespace lacuna::io {

struct PlanOutline {
  // The polygons, in coordinates of the scan, in groups whose boxes are mostly land.
  std::vector<std::vector<PlanPolygon>> groups;
  bool has_bay = false;   // wider than the void size
  bool has_dust = false;  // more than a hundredth of the cells are in parts that are left out
};

// Returns the outline of all points (io/explain/area/plan_shapes.hpp). Its reach is two edges of cells. The edge is
// the least power of two at which 95 % of the cells with points have three such neighbours of eight. So the
// outline depends on the points, but not on their order. A polygon has a hundredth of the area of the largest
// one at least. Where points cover no area, there is no group. Reads the scan once. Memory: 65,536 cells, as
// larger ones, and a raster of 4 MiB. Loads lacuna_gis.so. Throws `Error`.
PlanOutline outline_of_points(const ScanFiles& scan, double void_size, Progress& progress);

}  // namespace lacuna::io
