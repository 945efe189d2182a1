// SPDX-License-Identifier: Apache-2.0
// Coordinate reference systems in the database of PROJ, through GDAL: functions of lacuna_gis.so.
#pragma once

#include "engine/export.hpp"

#include <string>

namespace lacuna::io {

struct CrsLookup {
  std::string given;       // a code or well-known text
  std::string known_text;  // of it; empty: GDAL does not understand it
  std::string reason;      // GDAL's, where it does not
};

using LookUpCrs = void(CrsLookup& lookup);
using IsSameCrs = bool(const std::string& a, const std::string& b);  // false where GDAL does not understand

inline constexpr const char* kLookUpCrs = "lacuna_look_up_crs";
inline constexpr const char* kIsSameCrs = "lacuna_is_same_crs";
extern "C" LACUNA_API LookUpCrs lacuna_look_up_crs;
extern "C" LACUNA_API IsSameCrs lacuna_is_same_crs;

}  // namespace lacuna::io
