// SPDX-License-Identifier: Apache-2.0
#include "io/lids/make_lid.hpp"

#include "io/lids/fair.hpp"
#include "io/lids/refine.hpp"
#include "io/lids/relax_edges.hpp"
#include "io/lids/self_intersections.hpp"
#include "io/lids/triangulate_polygon.hpp"

#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

Lid without_lid(std::string reason) {
  return {.mesh = {}, .area = 0, .left_out = std::move(reason)};
}

// Relative to the first point: georeferenced coordinates keep their digits.
std::vector<Eigen::Vector3d> relative(const Loop& loop) {
  std::vector<Eigen::Vector3d> points;
  for (const LoopPoint& point : loop) points.push_back(point.position - loop[0].position);
  return points;
}

std::vector<Eigen::Vector3d> surface_of(const Loop& loop) {
  std::vector<Eigen::Vector3d> surface;
  for (const LoopPoint& point : loop) surface.push_back(point.surface.cast<double>());
  return surface;
}

// Moved back to the place of the loop, whose points keep all digits.
Lid placed(LidMesh mesh, const Loop& loop) {
  Lid lid{.mesh = std::move(mesh), .area = 0, .left_out = {}};
  lid.area = area(lid.mesh);
  for (std::size_t i = 0; i < lid.mesh.vertices.size(); ++i)
    lid.mesh.vertices[i] = i < loop.size() ? loop[i].position : lid.mesh.vertices[i] + loop[0].position;
  return lid;
}

}  // namespace

std::string left_out(std::uint64_t points) {
  if (points < 3) return "fewer than 3 points";
  if (points > kMostLoopPoints) return "more than " + std::to_string(kMostLoopPoints) + " points";
  return {};
}

Lid make_lid(const Loop& loop) {
  if (std::string reason = left_out(loop.size()); !reason.empty()) return without_lid(std::move(reason));
  const std::vector<Eigen::Vector3d> points = relative(loop);
  LidMesh unfaired = triangulate_polygon(points);
  if (!(area(unfaired) > 0)) return without_lid("all points in one line");
  relax_edges(unfaired);
  refine(unfaired);

  LidMesh lid = unfaired;
  const Fairing fairing = fair(lid, surface_of(loop));
  if (!has_intersections(lid)) return placed(std::move(lid), loop);
  if (fairing == Fairing::kThinPlate) {
    lid = unfaired;
    fair_membrane(lid);
    if (!has_intersections(lid)) return placed(std::move(lid), loop);
  }
  if (crosses_itself(points) && has_intersections(unfaired))
    return without_lid("the loop crosses itself and so does its lid");
  return placed(std::move(unfaired), loop);
}

}  // namespace lacuna::io
