// SPDX-License-Identifier: Apache-2.0
// Polygons of GeoJSON (RFC 7946).
#pragma once

#include "io/explain/area/held_polygons.hpp"

#include <filesystem>

namespace lacuna::io {

// Whether the first sign of the file is a brace. Throws `Error` if it is not a regular file.
bool looks_like_geojson(const std::filesystem::path& file);

// Fills in the polygons of all features, and the system of the file. That is longitude and latitude, unless a
// member `crs` names another, as in older files. Other geometries are passed over. The file is read corner by
// corner, so memory is that of the polygons. Throws `Error` if it is no GeoJSON, or has more corners than are
// allowed.
void read_geojson_polygons(HeldPolygons& polygons);

}  // namespace lacuna::io
