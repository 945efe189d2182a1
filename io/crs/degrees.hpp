// SPDX-License-Identifier: Apache-2.0
// Longitude and latitude, which RFC 7946 wants in a GeoJSON.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

inline constexpr const char* kDegreesCrs = "OGC:CRS84";

// Returns places in longitude and latitude of WGS 84, with z in metres. Places of a geocentric system have
// the height above the ellipsoid. Returns nothing if the system is empty, if lacuna_gis.so is missing,
// or if GDAL has no way that holds for all places. In the last two cases the log has a warning that names
// `file`.
std::optional<std::vector<Eigen::Vector3d>> to_degrees(const std::string& crs,
                                                       std::vector<Eigen::Vector3d> places,
                                                       const std::filesystem::path& file);

}  // namespace lacuna::io
