// SPDX-License-Identifier: Apache-2.0
// Polygons of a GIS file: a function of lacuna_gis.so.
#pragma once

#include "engine/export.hpp"
#include "io/area/held_polygons.hpp"

namespace lacuna::io {

// Fills in the polygons of all layers, unless they are there, as those of GeoJSON are: in the system
// `file_crs`. They are converted where both systems are known and differ. Edges are straight in the system of
// the file, as RFC 7946 has it. So they are cut until the parts bend by no more than `bend`. Of a GeoPackage,
// tables alone are read: a view may have no end. Throws `Error` if the file cannot be read, has a system that
// cannot be converted, or has more corners than are allowed.
using ReadAreaPolygons = void(HeldPolygons& polygons);

inline constexpr const char* kReadAreaPolygons = "lacuna_read_area_polygons";
extern "C" LACUNA_API ReadAreaPolygons lacuna_read_area_polygons;

}  // namespace lacuna::io
