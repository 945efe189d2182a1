// SPDX-License-Identifier: Apache-2.0
#include "io/crs/crs_lookup.hpp"

#include "io/crs/gdal_session.hpp"

#include <algorithm>

#include <cpl_conv.h>
#include <ogr_spatialref.h>

namespace lacuna::io {

extern "C" void lacuna_look_up_crs(CrsLookup& lookup) {
  register_gdal_drivers();
  const GdalFailures failures;
  OGRSpatialReference crs;
  char* text = nullptr;
  if (read_crs(lookup.given, crs) && crs.exportToWkt(&text) == OGRERR_NONE) lookup.known_text = text;
  CPLFree(text);
  lookup.reason = failures.first();
}

extern "C" bool lacuna_is_same_crs(const std::string& a, const std::string& b) {
  register_gdal_drivers();
  const GdalFailures failures;
  OGRSpatialReference first, second;
  return read_crs(a, first) && read_crs(b, second) && first.IsSame(&second) != 0;
}

extern "C" bool lacuna_convert_to_degrees(const std::string& crs, std::span<Eigen::Vector3d> places) {
  register_gdal_drivers();
  const GdalFailures failures;
  OGRSpatialReference system;
  if (!read_crs(crs, system)) return false;
  const auto conversion = conversion_to_degrees(system);
  return conversion && std::all_of(places.begin(), places.end(), [&](Eigen::Vector3d& place) {
           return convert_to_degrees(*conversion, place);
         });
}

}  // namespace lacuna::io
