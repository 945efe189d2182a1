// SPDX-License-Identifier: Apache-2.0
// triangulate_polygon: the triangles of least area between the points of a loop.
// Barequet, Sharir, *Filling gaps in the boundary of a polyhedron*, CAGD 1995.
#pragma once

#include "io/explain/lids/lid_mesh.hpp"

#include <span>

namespace lacuna::io {

// Loops of more points are triangulated in parts.
inline constexpr std::size_t kMostAtOnce = 200;

// Returns n - 2 triangles without new vertices, whose areas have the least sum, by dynamic programming over
// the diagonals. The area of a plane polygon is exactly that sum. Among sums that rounding could exchange,
// the function chooses any one.
//
// Differs from the paper: a longer loop is simplified first. The function removes the vertex with the
// smallest triangle between its neighbours, again and again, until kMostAtOnce are left. Their triangulation
// is the least one. Some of its edges stand for parts of the loop. Each triangle with such edges is replaced
// by a triangulation of the polygon of its parts. The sum is then near the least one.
//
// Precondition: three points or more. Cost: O(n min(n, kMostAtOnce)^2) time, 400 kB and O(n) memory.
LidMesh triangulate_polygon(std::span<const Eigen::Vector3d> loop);

// Triangulates between a loop and the islands in it, as one polygon (io/explain/lids/bridge_rings.hpp, which has the
// arguments, too). The ends of bridges and eight points of each island are never simplified away. Returns no
// triangles if there is no such triangulation. Precondition: each has three points or more, and there are
// kMostIslands or fewer.
inline constexpr std::size_t kMostIslands = 30;
LidMesh triangulate_rings(std::span<const Eigen::Vector3d> points, std::span<const std::size_t> sizes);

}  // namespace lacuna::io
