// SPDX-License-Identifier: Apache-2.0
// The coordinate reference system and the unit that the user states, `--crs` and `--unit`.
#pragma once

#include "io/options/options.hpp"

#include <string>

namespace lacuna::io {

struct StatedCrs {
  std::string crs;   // well-known text, or a code that is not looked up; empty: not stated
  std::string unit;  // "m" and so on, as stated or of the system; empty if neither is known
};

// Looks a code up in the database of PROJ. Without lacuna_gis.so the code stays as it is, and the log names
// the results that this leaves out. Throws `Error` if there is no such system, or if system and unit
// contradict.
StatedCrs read_stated_crs(const InputConfig& config);

// Whether two texts name the same system. Different texts are compared by GDAL; without lacuna_gis.so they
// are not the same.
bool is_same_crs(const std::string& a, const std::string& b);

}  // namespace lacuna::io
