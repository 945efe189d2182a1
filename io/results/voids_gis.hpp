// SPDX-License-Identifier: Apache-2.0
// The voids of an area as GeoPackage: a function of lacuna_gis.so.
#pragma once

#include "engine/export.hpp"
#include "io/area/area_check.hpp"

#include <filesystem>
#include <string>

namespace lacuna::io {

inline constexpr const char* kVoidsLayer = "lacuna_voids";
inline constexpr const char* kTilesLayer = "lacuna_area_tiles";
inline constexpr const char* kVoidsDescription = "voids of an area";

struct VoidsTask {
  const AreaCheck& check;
  std::string crs;              // as FileScan::common_crs
  std::filesystem::path name;   // what errors call it
  std::filesystem::path place;  // where it is made
};

// Writes the voids as polygons, with the columns of voids.csv, and the squares of the table. Returns false if
// GDAL does not understand the coordinate reference system, and the file has none. Throws `Error` with GDAL's
// text.
using WriteVoidsGis = bool(const VoidsTask& task);

inline constexpr const char* kWriteVoidsGis = "lacuna_write_voids_gis";
extern "C" LACUNA_API WriteVoidsGis lacuna_write_voids_gis;

}  // namespace lacuna::io
