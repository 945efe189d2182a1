// SPDX-License-Identifier: Apache-2.0
// check_scan: the voids of a scan within an area, the polygons of files or the scan's own outline.
//
// Idea: what no point covers is empty (empty_places.hpp). Circles around that are the voids (void_plan.cpp).
// For the outline, cells with points become coarser until nearly all have neighbours, as within an area. What
// lies within two cells of their points is covered, and the outline goes around that (outline.cpp).
#pragma once

#include "engine/export.hpp"
#include "engine/run/progress.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/explain/area/plan_raster.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {

struct ClassPolygons {
  std::string name;  // as in AreaClass
  std::vector<PlanPolygon> polygons;
};

// The polygons of an area, and the cells over them.
struct Area {
  std::vector<PlanPolygon> polygons, exceptions;  // in coordinates of the scan
  std::vector<ClassPolygons> classes;             // likewise
  double off = 0;           // how far polygons and exceptions may lie off, as their conversion says
  std::uint64_t bytes = 0;  // of all corners
  PlanGrid grid;
};

// The parts of `check_scan`.
inline constexpr const char* kAreaOptions = "--area, --except and --classes";
double from_metres(double metres, const ScanFiles& scan);  // a scan without a unit is taken to be in metres
double void_size_in(const ScanFiles& scan, const AreaConfig& config);  // diameter of the least void
// Reads the polygons of the config, of an outline without the area's own. Throws `Error`: a file that cannot
// be used, or too many corners for the memory limit.
Area read_area_files(const ScanFiles& scan, const FilesConfig& config, double void_size);
// Throws `Error` where the cells over the area, or its table, do not fit in memory.
void lay_cells(Area& area, double void_size, const Eigen::AlignedBox2d& bounds, const FilesConfig& config);
Eigen::AlignedBox2d bounds_of(std::span<const PlanPolygon> polygons);
// The sheet of a check shows the density in squares, a round number of units wide.
double tile_edge_of(const FilesConfig& config, double void_size, const Eigen::AlignedBox2d& bounds);

struct PlanOutline {
  // The polygons, in coordinates of the scan, in groups whose boxes are mostly land.
  std::vector<std::vector<PlanPolygon>> groups;
  double cell = 0;        // edge of the cells with points
  bool has_bay = false;   // wider than the void size
  bool has_dust = false;  // more than a hundredth of the cells are in parts that are left out
};

// Returns the outline of all points (plan_raster.hpp). Its reach is two edges of cells. The
// edge is the least power of two at which 95 % of the cells with points have three such neighbours of eight.
// So the outline depends on the points, but not on their order. A polygon has a hundredth of the area of the
// largest one at least. Where points cover no area, there is no group. Reads the scan once. Memory: 65,536
// cells, as larger ones, and a raster of 4 MiB. Loads lacuna_gis.so. Throws `Error`.
PlanOutline outline_of_points(const ScanFiles& scan, double void_size, Progress& progress);

// A place is empty if no point lies nearer to it than half of the void size, seen from above. Voids are what
// the circles around empty places cover within the area.
//
// The area has cells, whose edge is an eighth of the void size, and some are empty
// (empty_places.hpp). Voids are made of the cells near them: the middles of both are at most half of
// the void size apart. Cells that share edges are one void. The convex hull of the points in the bounds of
// the area cuts voids.
//
// The result names why the points do not decide, if they do not: see `Undecided`. Voids are listed all the
// same.
//
// A void counts unless all of its empty cells lie in exceptions. Where a file of the scan has return
// numbers, only first returns are points. Points of the flag synthetic cover nothing, unless the scan has no
// others. Points of about the same x, y, z and time count once. (Data voids in the Lidar Base Specification
// of the U.S. Geological Survey: its least void has four nominal pulse spacings.)
//
// Points whose heights lie apart cover nothing (empty_places.hpp), unless the config has bounds of
// heights. The gap is 100 m, or ten void sizes if that is more. Structures leave no such gap between their
// points and those of the ground, but for lone roofs.
//
// Reads the scan once or twice, and once or twice more where heights lie apart or points do not fit in
// memory. Memory: 3 or 4 bits for each cell in the bounds of the area, and the outlines. Cost: linear in
// points and in cells. Throws `Error` where outlines do not fit in memory.
//
// Without an area, the config means the scan's own outline. The outline is never
// `covered`, but covered within itself, or not decided where it has several polygons or leaves out a bay. Its
// polygons are checked in their groups, and each group reads the scan like an area.
LACUNA_API AreaCheck check_scan(const ScanFiles& scan, const FilesConfig& config, Progress& progress);

}  // namespace lacuna::io
