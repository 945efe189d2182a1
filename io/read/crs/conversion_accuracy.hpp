// SPDX-License-Identifier: Apache-2.0
// How exact a conversion between coordinate reference systems is, as PROJ states it: functions of
// lacuna_gis.so.
#pragma once

#include "engine/export.hpp"

#include <string>

#include <Eigen/Core>

class OGRSpatialReference;

namespace lacuna::io {

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

}  // namespace lacuna::io
