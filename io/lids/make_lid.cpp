// SPDX-License-Identifier: Apache-2.0
#include "io/lids/make_lid.hpp"

#include "io/lids/fair.hpp"
#include "io/lids/refine.hpp"
#include "io/lids/relax_edges.hpp"
#include "io/lids/self_intersections.hpp"
#include "io/lids/triangulate_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

Lid without_lid(std::string reason) {
  return {.mesh = {}, .area = 0, .left_out = std::move(reason)};
}

// A loop as it is triangulated. It begins where its shape says, so that ids do not change the lid. Its
// coordinates are at most 1: squares of lengths neither overflow nor lose digits.
struct Normalised {
  std::size_t start = 0;   // the point of the loop that is the first one here: the farthest from the middle
  Eigen::Vector3d middle;  // of the points
  double scale = 1;        // a power of 2
  std::vector<Eigen::Vector3d> points, surface;  // of the loop, then of the islands
  std::vector<std::size_t> sizes;                // of the loop and the islands
};

Normalised normalised(const Loop& loop, std::span<const Loop> islands) {
  const std::size_t n = loop.size();
  Normalised made;
  made.middle.setZero();
  for (const LoopPoint& point : loop)
    made.middle += (point.position() - loop[0].position()) / static_cast<double>(n);
  made.middle += loop[0].position();
  double extent = 0;
  for (const LoopPoint& point : loop)
    extent = std::max(extent, (point.position() - made.middle).cwiseAbs().maxCoeff());
  made.scale = std::ldexp(1.0, std::ilogb(std::max(extent, std::numeric_limits<double>::min())) + 1);
  const auto place = [&](const LoopPoint& point) {
    return Eigen::Vector3d((point.position() - made.middle) / made.scale);
  };
  const auto add = [&](const LoopPoint& point) {
    made.points.push_back(place(point));
    made.surface.push_back(Eigen::Vector3f(point.surface.data()).cast<double>());
  };
  double farthest = -1;
  for (std::size_t i = 0; i < n; ++i) {
    const double distance = place(loop[i]).squaredNorm();
    if (distance > farthest) {
      farthest = distance;
      made.start = i;
    }
  }
  for (std::size_t i = 0; i < n; ++i) add(loop[(made.start + i) % n]);
  made.sizes = {n};
  for (const Loop& island : islands) {
    for (const LoopPoint& point : island) add(point);
    made.sizes.push_back(island.size());
  }
  return made;
}

// Moves vertices back to the place and the order of the loop. Its points and the points of islands keep all
// digits.
Lid placed(LidMesh mesh, const Normalised& normalised, const Loop& loop, std::span<const Loop> islands) {
  const std::size_t n = loop.size();
  Lid lid{.mesh = std::move(mesh), .area = 0, .left_out = {}};
  lid.area = area(lid.mesh) * normalised.scale * normalised.scale;
  for (Eigen::Vector3d& vertex : lid.mesh.vertices)
    vertex = Eigen::Vector3d(vertex * normalised.scale + normalised.middle);
  auto vertex = lid.mesh.vertices.begin();
  for (const LoopPoint& point : loop) *vertex++ = point.position();
  for (const Loop& island : islands) {
    for (const LoopPoint& point : island) *vertex++ = point.position();
  }
  for (LidTriangle& triangle : lid.mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      if (corner < n) corner = static_cast<std::uint32_t>((corner + normalised.start) % n);
    }
  }
  return lid;
}

}  // namespace

std::string left_out(std::uint64_t points, std::size_t islands) {
  if (points < 3) return "fewer than 3 points";
  if (points > kMostLoopPoints) return "more than " + std::to_string(kMostLoopPoints) + " points";
  if (islands > kMostIslands) return "more than " + std::to_string(kMostIslands) + " islands in it";
  return {};
}

Lid make_lid(const Loop& loop, std::span<const Loop> islands) {
  std::size_t points = loop.size();
  for (const Loop& island : islands) points += island.size();
  if (std::string reason = left_out(points, islands.size()); !reason.empty())
    return without_lid(std::move(reason));
  const Normalised shape = normalised(loop, islands);
  LidMesh unfaired = triangulate_rings(shape.points, shape.sizes);
  constexpr const char* kPassesThrough = "the lid passes through itself";
  if (unfaired.triangles.empty()) return without_lid(kPassesThrough);
  constexpr double kNoArea = 1e-12;
  if (!(area(unfaired) > kNoArea)) return without_lid("all points in one line");
  relax_edges(unfaired);
  refine(unfaired);

  LidMesh lid = unfaired;
  const Fairing fairing = fair(lid, shape.surface);
  if (!has_intersections(lid)) return placed(std::move(lid), shape, loop, islands);
  if (fairing == Fairing::kThinPlate) {
    lid = unfaired;
    fair_membrane(lid);
    if (!has_intersections(lid)) return placed(std::move(lid), shape, loop, islands);
  }
  if (has_intersections(unfaired)) {
    return without_lid(crosses_itself(std::span(shape.points).first(loop.size()))
                           ? "the loop crosses itself, and its lid does"
                           : kPassesThrough);
  }
  return placed(std::move(unfaired), shape, loop, islands);
}

}  // namespace lacuna::io
