// SPDX-License-Identifier: Apache-2.0
// find_empty_places: the cells of an area with a place that no point is near.
#pragma once

#include "engine/run/progress.hpp"
#include "io/explain/area/area_tiles.hpp"
#include "io/explain/area/convex_hull.hpp"
#include "io/explain/area/height_groups.hpp"
#include "io/explain/area/plan_raster.hpp"
#include "io/explain/area/point_density.hpp"
#include "io/explain/area/repeated_points.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <cstdint>
#include <functional>
#include <set>
#include <vector>

namespace lacuna::io {

// A place is empty if no point is nearer than this. In cells: half of the void size.
inline constexpr double kEmptyRadius = PlanGrid::kCells / 2;

// The points of a scan, seen from above.
struct PlanOfPoints {
  // Cells of the area whose middles are empty, and cells with another empty place without such a neighbour.
  PlanRaster empty;
  PointDensity density;
  Ring2 hull;  // convex, of the points in the bounds of the area; in cells
  // In the area: first returns that were measured, later returns, and others that were not measured.
  std::uint64_t points = 0, later_returns = 0, synthetic = 0;
  std::set<double> swaths;     // values of point_source_id of the points in the area
  std::uint64_t repeated = 0;  // points that are there once more; about so many where they do not count once
  std::uint64_t near = 0;      // points without a time that lie as near to another as its rounded copy may
  ScanCounts counts;           // of the pass over the scan
  bool counts_once = true;     // false: `points` has them as often as they are there
  bool all_synthetic = false;  // so that the whole scan has no other points, and these count
  std::vector<HeightGroup> apart;     // heights of points in the bounds of the area that cover nothing
  bool has_voids_with_apart = false;  // `has_voids` of the cells that are empty if these points count
};

// What a check of an area counts.
struct PointRules {
  double height_gap = 0;  // of HeightGroups; 0: all heights count
  CopyDistance copies;
};

// Reads the scan, without later returns and synthetic points. The first pass decides all cells but those
// whose middle is nearly empty. Where such cells are, a second pass collects the points near them. A cell is
// divided until its parts are decided, or 64 times smaller. So the size of a circle is exact to a five
// hundredth, whatever the grid. Adds the points to `tiles`. Repeated points count once, if `memory` bytes
// hold all points; else the pass is made again. So it is where heights of points lie apart; those cover
// nothing. `has_voids` gets the cells with empty middles after such a pass, and after the first one that
// holds; it may throw. Throws `Error` where the points near undecided cells need more than `memory` bytes.
PlanOfPoints find_empty_places(const PlanGrid& grid, const PlanRaster& inside, const PointRules& rules,
                               std::uint64_t memory, const ScanFiles& scan, AreaTiles& tiles,
                               Progress& progress,
                               const std::function<bool(const PlanRaster& empty)>& has_voids);

}  // namespace lacuna::io
