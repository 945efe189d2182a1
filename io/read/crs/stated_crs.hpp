// SPDX-License-Identifier: Apache-2.0
// The coordinate reference system and the unit that the user states, `--crs` and `--unit`.
#pragma once

#include "io/read/crs/crs_lookup.hpp"
#include "io/read/options/options.hpp"

#include <optional>
#include <string>

namespace lacuna::io {

struct StatedCrs {
  std::string crs;     // well-known text, or a code that is not looked up; empty: not stated
  std::string unit;    // "m" and so on, as stated or of the system; empty if neither is known
  std::string unit_z;  // likewise of z; empty: as the files say, or as x and y
};

// Looks a code up in the database of PROJ. Without lacuna_gis.so the code stays as it is, and the log names
// the results that this leaves out. Throws `Error` if there is no such system, or if system and unit
// contradict.
StatedCrs read_stated_crs(const InputConfig& config);

// Returns the well-known text of a code, without its vertical part if only that is unknown. Other text stays
// as it is. Returns an empty text if GDAL does not know the code, or without lacuna_gis.so.
std::string known_text(const std::string& crs);

// Returns the scale of a projected system at a place. Returns nothing for other systems, for places that it
// does not have, and without lacuna_gis.so.
std::optional<ProjectionScale> scale_at(const std::string& crs, const Eigen::Vector3d& place);

// Whether two texts name the same system. Different texts are compared by GDAL; without lacuna_gis.so they
// are not the same.
bool is_same_crs(const std::string& a, const std::string& b);

}  // namespace lacuna::io
