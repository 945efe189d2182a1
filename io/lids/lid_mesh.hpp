// SPDX-License-Identifier: Apache-2.0
// The triangles of a lid: a disc whose boundary is the loop, without the islands in it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

using LidTriangle = std::array<std::uint32_t, 3>;  // indices of vertices

struct LidMesh {
  std::vector<Eigen::Vector3d> vertices;  // the loop's first, in its order; the islands', then inner ones
  std::size_t loop_points = 0;            // of the loop and its islands
  // Each edge of a loop is on one triangle, in the direction of the outer loop, or against it for islands.
  // Each other edge is on two, once in each direction.
  std::vector<LidTriangle> triangles;
};

// Half of the cross product of two edges: its length is the area, its direction the side from which the
// corners run anticlockwise.
Eigen::Vector3d area_vector(const LidMesh& mesh, const LidTriangle& triangle);

// Returns the sum of the areas of the triangles.
double area(const LidMesh& mesh);

// Returns the next vertex on its loop for each point of the loops, in the direction of the triangles.
std::vector<std::uint32_t> next_on_loops(const LidMesh& mesh);

// Returns, for each triangle and corner, the triangle across the edge that is opposite to the corner;
// kNoTriangle at the loop.
inline constexpr std::uint32_t kNoTriangle = UINT32_MAX;
using LidNeighbours = std::vector<LidTriangle>;
LidNeighbours neighbours(const LidMesh& mesh);

}  // namespace lacuna::io
