// SPDX-License-Identifier: Apache-2.0
// Coordinate reference systems in the database of PROJ, and how exact conversions between them are: functions
// of lacuna_gis.so.
#pragma once

#include "engine/export.hpp"

#include <span>
#include <string>

#include <Eigen/Core>

class OGRSpatialReference;

namespace lacuna::io {

// How exact a conversion between coordinate reference systems is, as PROJ states it: functions of
// lacuna_gis.so.

struct ConversionAccuracy {
  double metres = 0;         // 0: exact, or not stated; infinite: not known
  bool moves_datum = false;  // false: both systems are taken for one datum, such as ETRS89 and WGS 84
  std::string missing_grid;  // of a better way, which PROJ does not find on this machine; empty: none
  double with_grid = 0;      // metres, with that grid

  // Returns "to 2 m only, as PROJ does not find the grid uk_os_OSTN15_NTv2_OSGBtoETRS.tif, which gives 1 m".
  std::string print() const;
};

// Returns the accuracy of the way that GDAL takes near a place, which is in the system `from`.
ConversionAccuracy accuracy_of(const OGRSpatialReference& from, const OGRSpatialReference& to,
                               const Eigen::Vector3d& place);

// Fills in the accuracy from a system to longitude and latitude of WGS 84. False where GDAL does not
// understand the system.
using FindDegreesAccuracy = bool(const std::string& crs, const Eigen::Vector3d& place,
                                 ConversionAccuracy& accuracy);
inline constexpr const char* kFindDegreesAccuracy = "lacuna_find_degrees_accuracy";
extern "C" LACUNA_API FindDegreesAccuracy lacuna_find_degrees_accuracy;

// What PROJ knows of a coordinate reference system.
struct CrsFacts {
  std::string known_text;      // well-known text; empty if GDAL does not understand the system
  std::string horizontal;      // of its horizontal part
  std::string code;            // "EPSG:N" of that part; empty if it has none
  std::string reason;          // GDAL's, where it does not understand the system, or its vertical part
  bool is_whole = false;       // false: without a vertical part that GDAL does not understand
  bool has_positions = false;  // false: heights alone
  bool is_geographic = false;  // positions are longitude and latitude
  bool is_geocentric = false;  // positions are from the centre of the Earth
  double metres = 0;           // of the unit of x and y; 0: they are no lengths
  double metres_of_z = 0;      // of the unit of its vertical part; 0: it has none
};

struct ProjectionScale {
  // The lengths in coordinates over the true ones on the ellipsoid, along x and along y, which is 1 at best.
  double scale_x = 1, scale_y = 1;
  double longitude = 0, latitude = 0;  // in degrees
};

using LookUpCrs = void(const std::string& crs, CrsFacts& facts);  // a code or well-known text
// False where the system is not projected, or does not have the place.
using FindScale = bool(const std::string& crs, const Eigen::Vector3d& place, ProjectionScale& scale);
using IsSameCrs = bool(const std::string& a, const std::string& b);  // false where GDAL does not understand
// Works as to_degrees() of io/read/crs/crs.hpp. Returns false if GDAL does not convert all places; then
// some may be changed.
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
