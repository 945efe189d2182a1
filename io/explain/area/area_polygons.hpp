// SPDX-License-Identifier: Apache-2.0
// The polygons of files of an area, which are held in memory, and the bound on them.
#pragma once

#include "engine/export.hpp"
#include "engine/run/error.hpp"
#include "io/explain/area/plan_raster.hpp"
#include "io/read/crs/crs_lookup.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
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
  // The corners of all files so far, the most in one polygon, and the bytes that they may take.
  std::uint64_t corners = 0, most_in_one = 0, memory = 0;
};

// Bytes of a corner in the list, and while its polygon is read, drawn or written. These are copies, crossings
// with rows, and buffers of GDAL and SQLite.
inline constexpr std::uint64_t kBytesHeld = 40, kBytesAtWork = 40;

// Returns the bytes that so many corners take, with the one polygon that is read, drawn or written.
inline std::uint64_t bytes_of_corners(std::uint64_t all, std::uint64_t most_in_one) {
  return all * kBytesHeld + most_in_one * kBytesAtWork;
}

// Throws `Error` if a further polygon with so many corners takes more than the memory.
inline void check_corners(const HeldPolygons& polygons, std::uint64_t more) {
  const std::uint64_t all = polygons.corners + more, most = std::max(polygons.most_in_one, more);
  if (bytes_of_corners(all, most) <= polygons.memory) return;
  throw Error(polygons.file + ": " + std::to_string(all) + " corners of polygons, " + std::to_string(most) +
              " of them in one, take more than the " + std::to_string(polygons.memory >> 20) +
              " MiB that the memory limit leaves for them; allowed: " +
              std::to_string(polygons.memory / (kBytesHeld + kBytesAtWork)) + " in one, or a higher limit");
}

// Adds a ring without its repeated corner. One of fewer than three corners is left out.
inline void add_ring(Ring2 ring, PlanPolygon& polygon) {
  if (!ring.empty() && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) return;
  ring.shrink_to_fit();
  polygon.push_back(std::move(ring));
}

// Adds a polygon that was read, and counts its corners. Throws `Error` if one is not within 1e30, as
// points are.
inline void take_polygon(PlanPolygon polygon, HeldPolygons& polygons) {
  std::uint64_t corners = 0;
  for (const Ring2& ring : polygon) {
    corners += ring.size();
    if (!std::ranges::all_of(
            ring, [](const Eigen::Vector2d& corner) { return (corner.array().abs() <= 1e30).all(); }))
      throw Error(polygons.file + ": has a corner beyond 1e30, or one that is not finite");
  }
  polygons.corners += corners;
  polygons.most_in_one = std::max(polygons.most_in_one, corners);
  polygons.polygons.push_back(std::move(polygon));
}

// Fills in the polygons of all layers, unless they are there, as of GeoJSON: in the system
// `file_crs`. They are converted where both systems are known and differ. Edges are straight in the system of
// the file, as RFC 7946 has it. So they are cut until the parts bend by no more than `bend`. Of a GeoPackage,
// tables alone are read: a view may have no end. Throws `Error` if the file cannot be read, has a system that
// cannot be converted, or has more corners than are allowed.
using ReadAreaPolygons = void(HeldPolygons& polygons);

inline constexpr const char* kReadAreaPolygons = "lacuna_read_area_polygons";
extern "C" LACUNA_API ReadAreaPolygons lacuna_read_area_polygons;

// Whether the first sign of the file is a brace. Throws `Error` if it is not a regular file.
bool looks_like_geojson(const std::filesystem::path& file);

// Fills in the polygons of all features, and the system of the file. That is longitude and latitude, unless a
// member `crs` names another, as in older files. Other geometries are passed over. The file is read corner by
// corner, so only the polygons take memory. Throws `Error` if it is no GeoJSON, or has more corners than are
// allowed.
void read_geojson_polygons(HeldPolygons& polygons);

}  // namespace lacuna::io
