// SPDX-License-Identifier: Apache-2.0
// The voids of an area as GeoPackage: a function of lacuna_gis.so.
#pragma once

#include "engine/export.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/write/results/gis_output.hpp"

namespace lacuna::io {

inline constexpr const char* kVoidsLayer = "lacuna_voids";
inline constexpr const char* kAreaLayer = "lacuna_area";
inline constexpr const char* kTilesLayer = "lacuna_area_tiles";

// Writes the voids as polygons, with the columns of voids.csv, and the squares of the table. Returns false if
// GDAL does not understand the coordinate reference system, and the file has none. Throws `Error` with GDAL's
// text.
using WriteVoidsGis = bool(const AreaCheck& check, const GisOutput& out);

inline constexpr const char* kWriteVoidsGis = "lacuna_write_voids_gis";
extern "C" LACUNA_API WriteVoidsGis lacuna_write_voids_gis;

}  // namespace lacuna::io
