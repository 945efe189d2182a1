// SPDX-License-Identifier: Apache-2.0
// The area that is checked: the polygons of files, or the scan's own outline, and the cells over it.
//
// Idea of the outline: cells with points become coarser until nearly all have neighbours, as within an area.
// What lies within two cells of their points is covered, and the outline goes around that
// (plan_shapes.hpp).
#pragma once

#include "engine/export.hpp"
#include "engine/run/progress.hpp"
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

// Returns nothing where the config has no area. Throws `Error`: a file that cannot be used, or too many
// corners or cells for the memory limit.
LACUNA_API std::optional<Area> read_area(const ScanFiles& scan, const FilesConfig& config);

// What `read_area` is made of, for a check of the scan's own outline.
inline constexpr const char* kAreaOptions = "--area, --except and --classes";
double from_metres(double metres, const ScanFiles& scan);  // a scan without a unit is taken to be in metres
double void_size_in(const ScanFiles& scan, const AreaConfig& config);  // diameter of the least void
Area read_area_files(const ScanFiles& scan, const FilesConfig& config, double void_size,
                     const char* user);  // `user` needs the plan
// Throws `Error` where the cells over the area, or its table, do not fit in memory.
void lay_cells(Area& area, double void_size, const Eigen::AlignedBox2d& bounds, const FilesConfig& config);
Eigen::AlignedBox2d bounds_of(std::span<const PlanPolygon> polygons);
// The sheet of a check shows the density in squares, a round number of units wide.
double tile_edge_of(const FilesConfig& config, double void_size, const Eigen::AlignedBox2d& bounds);

struct PlanOutline {
  // The polygons, in coordinates of the scan, in groups whose boxes are mostly land.
  std::vector<std::vector<PlanPolygon>> groups;
  bool has_bay = false;   // wider than the void size
  bool has_dust = false;  // more than a hundredth of the cells are in parts that are left out
};

// Returns the outline of all points (plan_shapes.hpp). Its reach is two edges of cells. The
// edge is the least power of two at which 95 % of the cells with points have three such neighbours of eight.
// So the outline depends on the points, but not on their order. A polygon has a hundredth of the area of the
// largest one at least. Where points cover no area, there is no group. Reads the scan once. Memory: 65,536
// cells, as larger ones, and a raster of 4 MiB. Loads lacuna_gis.so. Throws `Error`.
PlanOutline outline_of_points(const ScanFiles& scan, double void_size, Progress& progress);

}  // namespace lacuna::io
