// SPDX-License-Identifier: Apache-2.0
// Places that represent the inside of a hole.
#pragma once

#include "engine/model/detection.hpp"

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

struct InnerSample {
  Eigen::Vector3d position, normal;  // the normal of length 1, on either side
  double area;                       // that the place represents
};

// Returns at least 256 places, spread evenly over the triangles of least area
// (io/explain/lids/triangulate_polygon.hpp) between some 64 points of the loop. The sum of the places' areas is the
// area of the triangles. Returns none if the loop has no area. The first kMostIslands of the islands in it
// are left out, each by some 16 points. Cost: 0.3 ms, and reading the loop.
std::vector<InnerSample> inside_places(const Detection& detection, std::size_t loop);
// This overload takes the points of a loop.
std::vector<InnerSample> inside_places(std::span<const Eigen::Vector3d> loop);

}  // namespace lacuna::io
