// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/degrees.hpp"

#include "io/read/crs/conversion_accuracy.hpp"
#include "io/read/crs/crs_lookup.hpp"
#include "io/read/crs/gis_module.hpp"

#include <cmath>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

namespace lacuna::io {

std::optional<std::vector<Eigen::Vector3d>> to_degrees(const std::string& crs,
                                                       std::vector<Eigen::Vector3d> places,
                                                       const std::filesystem::path& file) {
  if (crs.empty()) return std::nullopt;
  auto* const convert = reinterpret_cast<ConvertToDegrees*>(find_gis_function(kConvertToDegrees));
  const Eigen::Vector3d first = places.empty() ? Eigen::Vector3d(0, 0, 0) : places.front();
  if (convert != nullptr && convert(crs, places)) {
    if (!places.empty()) warn_of_accuracy(crs, first, file);
    return places;
  }
  spdlog::warn("{}: {}; GIS will read its coordinates, which are those of the scan, as degrees",
               file.string(),
               convert == nullptr ? "lacuna_gis.so is missing, which converts to longitude and latitude"
                                  : "GDAL cannot convert the coordinate reference system of the scan to "
                                    "longitude and latitude there");
  return std::nullopt;
}

std::string ConversionAccuracy::print() const {
  const std::string error =
      std::isfinite(metres) ? fmt::format("to {:g} m only", metres) : "with an error that is not known";
  if (missing_grid.empty()) return error;
  return fmt::format("{}; PROJ does not find the grid {}, which gives {:g} m", error, missing_grid,
                     with_grid);
}

void warn_of_accuracy(const std::string& crs, const Eigen::Vector3d& place,
                      const std::filesystem::path& file) {
  constexpr double kMetre = 1;
  auto* const find = reinterpret_cast<FindDegreesAccuracy*>(find_gis_function(kFindDegreesAccuracy));
  ConversionAccuracy accuracy;
  if (find == nullptr || !find(crs, place, accuracy)) return;
  if (accuracy.moves_datum && accuracy.metres > kMetre)
    spdlog::warn("{}: longitude and latitude hold {}", file.string(), accuracy.print());
}

}  // namespace lacuna::io
