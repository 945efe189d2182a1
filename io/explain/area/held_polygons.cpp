// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/explain/area/area_polygons.hpp"

#include <algorithm>
#include <utility>

namespace lacuna::io {
namespace {

// Bytes of a corner in the list, and while its polygon is read, drawn or written. These are copies, crossings
// with rows, and buffers of GDAL and SQLite.
constexpr std::uint64_t kHeld = 40, kAtWork = 40;

constexpr double kMostCoordinate = 1e30;  // as of points

}  // namespace

std::uint64_t bytes_of_corners(std::uint64_t all, std::uint64_t most_in_one) {
  return all * kHeld + most_in_one * kAtWork;
}

void check_corners(const HeldPolygons& polygons, std::uint64_t more) {
  const std::uint64_t all = polygons.corners + more, most = std::max(polygons.most_in_one, more);
  if (bytes_of_corners(all, most) <= polygons.memory) return;
  throw Error(polygons.file + ": " + std::to_string(all) + " corners of polygons, " + std::to_string(most) +
              " of them in one, take more than the " + std::to_string(polygons.memory >> 20) +
              " MiB that the memory limit leaves for them; allowed: " +
              std::to_string(polygons.memory / (kHeld + kAtWork)) + " in one, or a higher limit");
}

void add_ring(Ring2 ring, PlanPolygon& polygon) {
  if (!ring.empty() && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) return;
  ring.shrink_to_fit();
  polygon.push_back(std::move(ring));
}

void take_polygon(PlanPolygon polygon, HeldPolygons& polygons) {
  std::uint64_t corners = 0;
  for (const Ring2& ring : polygon) {
    corners += ring.size();
    if (!std::ranges::all_of(ring, [](const Eigen::Vector2d& corner) {
          return (corner.array().abs() <= kMostCoordinate).all();
        }))
      throw Error(polygons.file + ": has a corner beyond 1e30, or one that is not finite");
  }
  polygons.corners += corners;
  polygons.most_in_one = std::max(polygons.most_in_one, corners);
  polygons.polygons.push_back(std::move(polygon));
}

}  // namespace lacuna::io
