// SPDX-License-Identifier: Apache-2.0
// coverage.tif: a raster for GIS, through GDAL, in lacuna_gis.so (io/write/results/gis_output.hpp says why).
#pragma once

#include "engine/export.hpp"
#include "io/write/results/coverage_grid.hpp"
#include "io/write/results/gis_output.hpp"

namespace lacuna::io {

// A function that writes a GeoTIFF with three bands of 32-bit floats. They have for each cell its points,
// their spacing, and the share of the cell within holes. The spacing is the root of the cell's area over its
// points, NaN without points. Returns false if GDAL does not understand the coordinate reference system, and
// the file has none. Throws `Error` with GDAL's text.
using WriteCoverage = bool(const CoverageGrid& grid, const GisOutput& out);

inline constexpr const char* kWriteCoverage = "lacuna_write_coverage";
extern "C" LACUNA_API WriteCoverage lacuna_write_coverage;

}  // namespace lacuna::io
