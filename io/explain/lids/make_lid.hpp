// SPDX-License-Identifier: Apache-2.0
// make_lid: triangles that close a hole. It is a preview of filling, not a reconstruction.
#pragma once

#include "engine/model/loop.hpp"
#include "io/explain/lids/lid_mesh.hpp"

#include <span>
#include <string>

namespace lacuna::io {

// Loops of more points, with their islands, have no lid.
inline constexpr std::size_t kMostLoopPoints = 5000;

// Memory that make_lid takes at most, with the points of the loop.
inline constexpr std::size_t kLidBytes = 4 << 20;

// Returns why a loop has no lid; empty if it may have one. `points`: of the loop and of its islands.
std::string left_out(std::uint64_t points, std::size_t islands = 0);

struct Lid {
  LidMesh mesh;          // no triangles without a lid
  double area = 0;       // of the triangles, in squares of the unit of the scan
  std::string left_out;  // why it has no lid; empty if it has one
};

// Returns the triangulation of least area between the points of the loop and of the islands, which stay open.
// Its triangles run in the loop's direction, so its side is the side of the loop's normal. A lid crosses
// itself where its loop does.
//
// There is no lid of too many points, fewer than three, or all in one line. There is none, either, if an edge
// would have more than two triangles, as bridges to islands can make one. Equal loops give equal lids. Cost: the sum of
// the steps' costs, below 1 s for kMostLoopPoints.
Lid make_lid(const Loop& loop, std::span<const Loop> islands = {});

}  // namespace lacuna::io
