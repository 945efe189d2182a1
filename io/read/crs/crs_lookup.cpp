// SPDX-License-Identifier: Apache-2.0
#include "io/read/crs/crs_lookup.hpp"

#include "io/read/crs/gdal_session.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <cpl_conv.h>
#include <ogr_spatialref.h>

namespace lacuna::io {

extern "C" void lacuna_look_up_crs(CrsLookup& lookup) {
  const GdalFailures failures;
  OGRSpatialReference crs;
  char* text = nullptr;
  if (read_exact_crs(lookup.given, crs) && crs.exportToWkt(&text) == OGRERR_NONE) lookup.known_text = text;
  CPLFree(text);
  lookup.reason = failures.first();
}

extern "C" bool lacuna_find_scale(const std::string& crs, const Eigen::Vector3d& place,
                                  ProjectionScale& scale) {
  const GdalFailures failures;
  OGRSpatialReference system;
  if (!read_crs(crs, system) || system.IsProjected() == 0) return false;
  const double metre = system.GetLinearUnits();
  const auto conversion = conversion_to_degrees(system);
  if (!conversion.plan) return false;
  const double half = 50 / metre;  // of a step that is short for an ellipsoid and long for rounding
  const auto at = [&](double x, double y, Eigen::Vector3d& degrees) {
    degrees = {place.x() + x, place.y() + y, 0};
    return convert_to_degrees(conversion, degrees);
  };
  Eigen::Vector3d here, west, east, south, north;
  if (!at(0, 0, here) || !at(-half, 0, west) || !at(half, 0, east) || !at(0, -half, south) ||
      !at(0, half, north))
    return false;
  scale.longitude = here.x();
  scale.latitude = here.y();
  // Radii of curvature of WGS 84: along the parallel, and along the meridian.
  constexpr double kRadian = std::numbers::pi / 180, kAxis = 6378137, kSquare = 0.00669437999014;
  const double sine = std::sin(here.y() * kRadian), w = 1 - kSquare * sine * sine;
  const double along_parallel = kAxis / std::sqrt(w) * std::cos(here.y() * kRadian);
  const double along_meridian = kAxis * (1 - kSquare) / (w * std::sqrt(w));
  const auto scale_of = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const double turn = std::remainder(to.x() - from.x(), 360);
    const double length =
        std::hypot(turn * kRadian * along_parallel, (to.y() - from.y()) * kRadian * along_meridian);
    return 2 * half * metre / length;
  };
  scale.scale_x = scale_of(west, east);
  scale.scale_y = scale_of(south, north);
  return std::isfinite(scale.scale_x) && std::isfinite(scale.scale_y);
}

extern "C" bool lacuna_is_same_crs(const std::string& a, const std::string& b) {
  const GdalFailures failures;
  OGRSpatialReference first, second;
  return read_crs(a, first) && read_crs(b, second) && first.IsSame(&second) != 0;
}

extern "C" bool lacuna_convert_to_degrees(const std::string& crs, std::span<Eigen::Vector3d> places) {
  const GdalFailures failures;
  OGRSpatialReference system;
  if (!read_crs(crs, system)) return false;
  const auto conversion = conversion_to_degrees(system);
  return conversion.plan && std::all_of(places.begin(), places.end(), [&](Eigen::Vector3d& place) {
           return convert_to_degrees(conversion, place);
         });
}

}  // namespace lacuna::io
