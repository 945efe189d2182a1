// SPDX-License-Identifier: Apache-2.0
// The polygons of files of an area, which are held in memory, and the bound on them.
#pragma once

#include "engine/export.hpp"
#include "io/explain/area/plan_polygon.hpp"
#include "io/read/crs/crs_lookup.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lacuna::io {

struct HeldPolygons {
  std::string file;                   // GeoPackage, GeoJSON or Shapefile
  std::string crs;                    // of the scan, as CommonSystem::crs; empty if not known
  std::vector<PlanPolygon> polygons;  // in coordinates of the scan
  std::string file_crs;               // name of the file's system; empty if it has none
  bool is_converted = false;          // from that system
  ConversionAccuracy accuracy;        // of that conversion
  double bend = 0;                    // how far converted edges may be off, in units of the scan
  // The corners of all files so far, those of the polygon that has most, and the bytes that they may take.
  std::uint64_t corners = 0, most_in_one = 0, memory = 0;
};

// Returns the bytes that so many corners take, with those of the one polygon that is read, drawn or written.
std::uint64_t bytes_of_corners(std::uint64_t all, std::uint64_t most_in_one);

// Throws `Error` if a further polygon with so many corners takes more than the memory.
void check_corners(const HeldPolygons& polygons, std::uint64_t more);

// Adds a ring without its repeated corner. One of fewer than three corners is left out.
void add_ring(Ring2 ring, PlanPolygon& polygon);

// Adds a polygon that was read, and counts its corners. Throws `Error` if one is not within
// 1e30.
void take_polygon(PlanPolygon polygon, HeldPolygons& polygons);

// Fills in the polygons of all layers, unless they are there, as those of GeoJSON are: in the system
// `file_crs`. They are converted where both systems are known and differ. Edges are straight in the system of
// the file, as RFC 7946 has it. So they are cut until the parts bend by no more than `bend`. Of a GeoPackage,
// tables alone are read: a view may have no end. Throws `Error` if the file cannot be read, has a system that
// cannot be converted, or has more corners than are allowed.
using ReadAreaPolygons = void(HeldPolygons& polygons);

inline constexpr const char* kReadAreaPolygons = "lacuna_read_area_polygons";
extern "C" LACUNA_API ReadAreaPolygons lacuna_read_area_polygons;

}  // namespace lacuna::io
