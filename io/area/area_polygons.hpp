// SPDX-License-Identifier: Apache-2.0
// Polygons of a GIS file: a function of lacuna_gis.so.
#pragma once

#include "engine/export.hpp"
#include "io/area/plan_polygon.hpp"

#include <string>
#include <vector>

namespace lacuna::io {

struct AreaPolygons {
  std::string file;                   // GeoPackage, GeoJSON or Shapefile
  std::string crs;                    // of the scan, as FileScan::common_crs; empty if not known
  std::vector<PlanPolygon> polygons;  // in coordinates of the scan
  std::string file_crs;               // name of the file's system; empty if it has none
  bool is_converted = false;          // from that system
};

// Fills in the polygons of all layers. They are converted where both systems are known and differ. Throws
// `Error` if the file cannot be read, has no polygon, or has a system that cannot be converted.
using ReadAreaPolygons = void(AreaPolygons& polygons);

inline constexpr const char* kReadAreaPolygons = "lacuna_read_area_polygons";
extern "C" LACUNA_API ReadAreaPolygons lacuna_read_area_polygons;

}  // namespace lacuna::io
