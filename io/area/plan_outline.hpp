// SPDX-License-Identifier: Apache-2.0
// The outline of the points of a scan, seen from above.
#pragma once

#include "io/area/plan_raster.hpp"

#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {

// Returns how wide bays are at most that belong to the outline: a third of the shorter side of the points'
// box. So rivers belong to it, and what lies between the arms of an L does not.
double bay_of(const Eigen::AlignedBox2d& points);

// Returns cells over the box of points, and those around it that they cover.
PlanGrid grid_around(const Eigen::AlignedBox2d& points, double void_size);

// Returns the outline of the cells that are not empty (io/area/scan_outline.hpp), in coordinates of the scan.
// It has no polygon where points cover no square of the void size. It loads lacuna_gis.so. Throws `Error`.
std::vector<PlanPolygon> outline_of_points(const PlanRaster& empty, const PlanGrid& grid, double bay);

}  // namespace lacuna::io
