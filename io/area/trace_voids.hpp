// SPDX-License-Identifier: Apache-2.0
// Outlines of voids from a raster, by GDAL and GEOS: a function of lacuna_gis.so.
#pragma once

#include "engine/export.hpp"
#include "io/area/plan_polygon.hpp"
#include "io/area/polygonise.hpp"

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

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

}  // namespace lacuna::io
