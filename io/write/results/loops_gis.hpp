// SPDX-License-Identifier: Apache-2.0
// The loops for geographic information systems, through GDAL. GDAL costs 35 MiB and 70 ms at the start of a
// program. So the code that needs it is a library of its own, lacuna_gis.so. The program loads it where such
// a result is wanted.
#pragma once

#include "engine/export.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/write/results/gis_output.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace lacuna::io {

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

}  // namespace lacuna::io
