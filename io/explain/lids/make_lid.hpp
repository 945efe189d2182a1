// SPDX-License-Identifier: Apache-2.0
// make_lid: triangles that close a hole. It is a preview of filling, not a reconstruction.
//
// Idea: bridges join a loop and the islands in it to one polygon. Dynamic programming over its diagonals
// finds the triangles of least area (Barequet, Sharir, *Filling gaps in the boundary of a polyhedron*, CAGD
// 1995).
#pragma once

#include "engine/model/loop.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

using LidTriangle = std::array<std::uint32_t, 3>;  // indices of vertices

// The triangles between the points of a loop and of the islands in it.
struct LidMesh {
  std::vector<Eigen::Vector3d> vertices;  // the loop's first, in its order; then the islands'
  // Each edge of a loop is on one triangle, in the direction of the outer loop, or against it for islands.
  // Each other edge is on two, once in each direction.
  std::vector<LidTriangle> triangles;
};

// Half of the cross product of two edges: its length is the area, its direction the side from which the
// corners run anticlockwise.
Eigen::Vector3d area_vector(const LidMesh& mesh, const LidTriangle& triangle);

// Returns the sum of the areas of the triangles.
double area(const LidMesh& mesh);

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

// Triangulates between a loop and the islands in it, as one polygon. `points`: of the loop, then of the
// islands; `sizes`: their numbers of points. The ends of bridges and eight points of each island are never
// simplified away. Returns no triangles if there is no such triangulation. Precondition: each has three
// points or more, and there are kMostIslands or fewer.
inline constexpr std::size_t kMostIslands = 30;
LidMesh triangulate_rings(std::span<const Eigen::Vector3d> points, std::span<const std::size_t> sizes);

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
// would have more than two triangles, as bridges to islands can make one. Equal loops give equal lids. Cost:
// the sum of the steps' costs, below 1 s for kMostLoopPoints.
Lid make_lid(const Loop& loop, std::span<const Loop> islands = {});

}  // namespace lacuna::io
