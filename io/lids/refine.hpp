// SPDX-License-Identifier: Apache-2.0
// refine: vertices within a lid, about as dense as the points of its loop.
// Liepa, *Filling holes in meshes*, SGP 2003, section 4.
#pragma once

#include "io/lids/lid_mesh.hpp"

namespace lacuna::io {

// Inner vertices of a lid. A lid that would have more is coarser: its spacing is the loop's times a factor.
inline constexpr std::size_t kMostInnerVertices = 10'000;

// Divides triangles at their centroids and relaxes edges, in turns, until the triangles are as small as the
// spacing demands. A vertex of the loop has the mean length of its two edges as its spacing, a new vertex
// the mean of its three corners. The surface stays, but for swapped edges: in a plane, the area is the
// same. Expects a triangulation of a loop without inner vertices, with relaxed edges. Cost: O(n log n) for
// each of some ten rounds, n with new vertices.
void refine(LidMesh& mesh);

}  // namespace lacuna::io
