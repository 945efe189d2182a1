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
// `file`, and else that of warn_of_accuracy.
std::optional<std::vector<Eigen::Vector3d>> to_degrees(const std::string& crs,
                                                       std::vector<Eigen::Vector3d> places,
                                                       const std::filesystem::path& file);

// Warns where the conversion to longitude and latitude moves the datum, with an error of more than a metre.
// The log names `file`, the error, and the grid that PROJ lacks. The place is one of the scan.
void warn_of_accuracy(const std::string& crs, const Eigen::Vector3d& place,
                      const std::filesystem::path& file);

}  // namespace lacuna::io
