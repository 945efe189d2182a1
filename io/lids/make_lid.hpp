// SPDX-License-Identifier: Apache-2.0
// make_lid: a triangulated surface that closes a hole. It is a preview of filling, not a reconstruction.
#pragma once

#include "engine/model/loop.hpp"
#include "io/lids/lid_mesh.hpp"

#include <span>
#include <string>

namespace lacuna::io {

// Loops of more points, with their islands, have no lid.
inline constexpr std::size_t kMostLoopPoints = 5000;

// Memory that make_lid takes at most. Measured: the factor of the thin plate takes most of it.
inline constexpr std::size_t kLidBytes = 24 << 20;

// Returns why a loop has no lid; empty if it may have one. `points`: of the loop and of its islands.
std::string left_out(std::uint64_t points, std::size_t islands = 0);

struct Lid {
  LidMesh mesh;          // in the coordinates of the loop; no triangles without a lid
  double area = 0;       // of the triangles, in squares of the unit of the scan
  std::string left_out;  // why it has no lid; empty if it has one
};

// Returns the triangulation of least area, refined to the spacing of the loop and smoothed, so that it
// continues the surface around. It leaves the islands in the hole open, and its mesh begins with the points
// of the loop and of the islands, in order. Its triangles run in the loop's direction, so its side is the
// side of the loop's normal.
//
// A lid that passes through itself is made less smooth: a membrane, else without fairing. If the lid without
// fairing passes through itself, too, there is no lid. The reason then says whether the loop crosses itself
// along its normal. Other reasons are too many points, fewer than three, or all in one line. Another start of
// the loop, another place or a turn change the area within rounding. If a loop is symmetric, rounding may
// choose another triangulation. The area of a curved lid then changes by some 1e-4 of it. Equal loops give
// equal lids. Cost: the sum of the steps' costs, below 3 s for kMostLoopPoints.
Lid make_lid(const Loop& loop, std::span<const Loop> islands = {});

}  // namespace lacuna::io
