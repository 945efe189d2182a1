// SPDX-License-Identifier: Apache-2.0
// Coordinate reference systems in the database of PROJ, through GDAL: functions of lacuna_gis.so.
#pragma once

#include "engine/export.hpp"

#include <span>
#include <string>

#include <Eigen/Core>

namespace lacuna::io {

struct CrsLookup {
  std::string given;       // a code or well-known text
  std::string known_text;  // of the system; empty if GDAL does not understand it
  std::string reason;      // GDAL's, where it does not
};

struct ProjectionScale {
  // The lengths in coordinates over the true ones on the ellipsoid, along x and along y, which is 1 at best.
  double scale_x = 1, scale_y = 1;
  double longitude = 0, latitude = 0;  // in degrees
};

using LookUpCrs = void(CrsLookup& lookup);
// False where the system is not projected, or does not have the place.
using FindScale = bool(const std::string& crs, const Eigen::Vector3d& place, ProjectionScale& scale);
using IsSameCrs = bool(const std::string& a, const std::string& b);  // false where GDAL does not understand
// Works as to_degrees() of io/read/crs/degrees.hpp. Returns false if GDAL does not convert all places; then some
// may be changed.
using ConvertToDegrees = bool(const std::string& crs, std::span<Eigen::Vector3d> places);

inline constexpr const char* kLookUpCrs = "lacuna_look_up_crs";
inline constexpr const char* kFindScale = "lacuna_find_scale";
inline constexpr const char* kIsSameCrs = "lacuna_is_same_crs";
inline constexpr const char* kConvertToDegrees = "lacuna_convert_to_degrees";
extern "C" LACUNA_API LookUpCrs lacuna_look_up_crs;
extern "C" LACUNA_API FindScale lacuna_find_scale;
extern "C" LACUNA_API IsSameCrs lacuna_is_same_crs;
extern "C" LACUNA_API ConvertToDegrees lacuna_convert_to_degrees;

}  // namespace lacuna::io
