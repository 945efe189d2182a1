// SPDX-License-Identifier: Apache-2.0
// coverage.tif: a raster for GIS, through GDAL, in lacuna_gis.so (io/results/loops_gis.hpp says why).
#pragma once

#include "engine/export.hpp"
#include "io/results/coverage_grid.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace lacuna::io {

struct CoverageTask {
  const CoverageGrid& grid;
  std::string crs;              // as FileScan::common_crs
  std::filesystem::path name;   // what errors call it
  std::filesystem::path place;  // where it is made
};

// A function that writes a GeoTIFF with three bands of 32-bit floats. They have for each cell its points,
// their spacing, and the share of the cell within holes. The spacing is the root of the cell's area over its
// points, NaN without points. Returns false if GDAL does not understand the coordinate reference system, and
// the file has none. Throws `Error` with GDAL's text.
using WriteCoverage = bool(const CoverageTask& task);

inline constexpr const char* kWriteCoverage = "lacuna_write_coverage";
extern "C" LACUNA_API WriteCoverage lacuna_write_coverage;

inline constexpr std::string_view kCoverageSoftware = "Lacuna coverage";

}  // namespace lacuna::io
