// SPDX-License-Identifier: Apache-2.0
// Finds loops around places of the true surface where the scan has no points.
#pragma once

#include "bench/evaluation/loops_reader.hpp"
#include "bench/evaluation/mesh_reader.hpp"

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {

struct Surface {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Triangle> triangles;
};

// A scan and its spacing. Ids are places in `positions`.
struct Sampling {
  std::span<const Eigen::Vector3d> positions;
  std::span<const std::uint64_t> stand_ins;
  double spacing = 0;
};

// Returns for every loop its points at an unsampled place. Such a place of the surface is inside the loop and
// at most 2 r from the loop's point. No point of the scan is within r of it. Here r is 1.5 times the spacing
// at the loop's point (see spacing_at), and at least 1.5 spacings of the scan. "Inside" is decided along the
// normal of the loop's area.
//
// The surface is represented by finitely many places. Every triangle is halved at the middle of its longest
// edge until this edge is at most half a spacing. The places are the centroids. A triangle with a corner that
// is not finite has no places.
//
// Cost: n log n for the scan, log n for every triangle, and for every place near a loop.
std::vector<std::vector<bool>> points_at_unsampled(std::span<const LoopIds> loops, const Surface& surface,
                                                   const Sampling& sampling);

}  // namespace lacuna::evaluation
