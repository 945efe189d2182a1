// SPDX-License-Identifier: Apache-2.0
// The triangles between the points of a loop and of the islands in it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

using LidTriangle = std::array<std::uint32_t, 3>;  // indices of vertices

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

}  // namespace lacuna::io
