// SPDX-License-Identifier: Apache-2.0
#include "io/crs/degrees.hpp"

#include "io/crs/crs_lookup.hpp"
#include "io/crs/gis_module.hpp"

#include <spdlog/spdlog.h>

namespace lacuna::io {

std::optional<std::vector<Eigen::Vector3d>> to_degrees(const std::string& crs,
                                                       std::vector<Eigen::Vector3d> places,
                                                       const std::filesystem::path& file) {
  if (crs.empty()) return std::nullopt;
  auto* const convert = reinterpret_cast<ConvertToDegrees*>(find_gis_function(kConvertToDegrees));
  if (convert != nullptr && convert(crs, places)) return places;
  spdlog::warn("{}: {}; GIS will read its coordinates, which are those of the scan, as degrees",
               file.string(),
               convert == nullptr ? "lacuna_gis.so is missing, which converts to longitude and latitude"
                                  : "GDAL cannot convert the coordinate reference system of the scan to "
                                    "longitude and latitude there");
  return std::nullopt;
}

}  // namespace lacuna::io
