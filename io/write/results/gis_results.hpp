// SPDX-License-Identifier: Apache-2.0
// The results for geographic information systems, through GDAL: loops, voids, and the coverage in square
// cells viewed from above. GDAL costs 35 MiB and 70 ms at the start of a program. So the code that needs it
// is a library of its own, lacuna_gis.so. The program loads it where such a result is wanted.
#pragma once

#include "engine/export.hpp"
#include "engine/model/detection.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/read/files/output_file.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// Cells by row from north to south, each from west to east.
struct CoverageGrid {
  Eigen::Vector2d corner{0, 0};  // of the scan's bounds without strays: west, north; whole cells from 0 0
  double edge = 0;               // of a cell, in units of the scan
  std::size_t columns = 0, rows = 0;
  std::vector<float> points;  // that take part, copies too
  std::vector<float> holes;   // share of the cell within holes in the plan, [0, 1]

  std::size_t size() const { return columns * rows; }
};

// Reads every file once more. Holes on walls cover nothing from above, and islands are no part of their
// hole. If holes overlap, their sum counts, up to 1. Throws `Error` if there would be more cells than the
// memory limit has space for. Memory: 8 bytes a cell. Cost: linear in points, and in the cells that holes
// cross.
CoverageGrid cover(const Detection& detection, const ScanFiles& scan, const FilesConfig& config);

// Adds the share of each cell within a closed polygon, without its inner rings. Rows are cut into eight
// strips, and each strip's share is exact along its middle.
void add_polygon(const std::vector<Ring2>& rings, CoverageGrid& grid);

// A file that GDAL makes.
struct GisOutput {
  std::string crs;              // as CommonSystem::crs
  std::filesystem::path name;   // what errors call it
  std::filesystem::path place;  // where it is made
};

enum class GisFormat : std::uint8_t { kGeoPackage, kGeoJson };

// The layers of the files.
inline constexpr const char* kGisLayer = "lacuna_loops";
inline constexpr const char* kGisAreas = "lacuna_areas";  // the second one of a GeoPackage, with polygons

struct GisTask {
  const ExplainedDetection& detection;
  GisFormat format;
  bool with_polygons;
  std::string unit;  // as CommonSystem::unit
  GisOutput out;
  std::function<void(std::string_view text)> take;  // of a GeoJSON; may throw
};

// The fate of the scan's coordinate reference system in a file.
enum class GisCrs : std::uint8_t {
  kWritten,
  kNone,           // the scan has none
  kNotUnderstood,  // by GDAL: the file has none
  kNotConverted,   // a GeoJSON with the coordinates of the scan, though these are not longitude and latitude
};

struct GisWritten {
  GisCrs crs = GisCrs::kNone;
  std::size_t without_polygon = 0;  // loops that cover nothing, seen from above
};

// Writes the loops in order, each a closed line with z. Fields are id, kind, unit and the measures, empty if
// a measure is not finite. With polygons, a GeoPackage has these in a layer of their own, and GeoJSON
// has polygons in place of lines. A hole has its islands as inner rings, an outer curve its holes. The
// coordinates are the scan's, with all digits. The coordinates of a GeoJSON are longitude and latitude of
// WGS 84 if the system is known, as RFC 7946 demands. There z is in metres; for geocentric scans it is the
// ellipsoidal height. Holds one polygon in memory. Equal loops give equal bytes. Throws `Error` with
// GDAL's text.
using WriteLoopsGis = GisWritten(const GisTask& task);

// In lacuna_gis.so:
inline constexpr const char* kWriteLoopsGis = "lacuna_write_loops_gis";
extern "C" LACUNA_API WriteLoopsGis lacuna_write_loops_gis;

inline constexpr const char* kVoidsLayer = "lacuna_voids";
inline constexpr const char* kAreaLayer = "lacuna_area";
inline constexpr const char* kTilesLayer = "lacuna_area_tiles";

// Writes the voids as polygons, with the columns of voids.csv, and the squares of the table. Returns false if
// GDAL does not understand the coordinate reference system, and the file has none. Throws `Error` with GDAL's
// text.
using WriteVoidsGis = bool(const AreaCheck& check, const GisOutput& out);

inline constexpr const char* kWriteVoidsGis = "lacuna_write_voids_gis";
extern "C" LACUNA_API WriteVoidsGis lacuna_write_voids_gis;

// A function that writes a GeoTIFF with three bands of 32-bit floats. They have for each cell its points,
// their spacing, and the share of the cell within holes. The spacing is the root of the cell's area over its
// points, NaN without points. Returns false if GDAL does not understand the coordinate reference system, and
// the file has none. Throws `Error` with GDAL's text.
using WriteCoverage = bool(const CoverageGrid& grid, const GisOutput& out);

inline constexpr const char* kWriteCoverage = "lacuna_write_coverage";
extern "C" LACUNA_API WriteCoverage lacuna_write_coverage;

inline constexpr const char* kGisUser = "--gpkg, --geojson, --coverage and --area";  // for errors

// Loads the library on first use and writes the loops. The log has a warning if the scan has a coordinate
// reference system and the file has none. Another warning comes if GIS will read metres as degrees. Throws
// `Error`.
void write_loops_gis(const ExplainedDetection& detection, const ScanFiles& scan, const OutputConfig& config,
                     GisFormat format, OutputFile& out);

// Writes coverage.tif in the same way; writes no file if no point takes part.
void write_coverage(const Detection& detection, const ScanFiles& scan, const FilesConfig& config,
                    OutputFile& out);

// Writes voids.gpkg in the same way.
void write_voids_gpkg(const AreaCheck& check, const ScanFiles& scan, OutputFile& out);

}  // namespace lacuna::io
