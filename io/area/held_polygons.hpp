// SPDX-License-Identifier: Apache-2.0
// The polygons of files of an area, which are held in memory, and the bound on them.
#pragma once

#include "io/area/plan_polygon.hpp"
#include "io/crs/conversion_accuracy.hpp"

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

}  // namespace lacuna::io
