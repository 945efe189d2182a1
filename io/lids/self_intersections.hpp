// SPDX-License-Identifier: Apache-2.0
// Whether a loop or a lid passes through itself.
#pragma once

#include "io/lids/lid_mesh.hpp"

#include <span>

namespace lacuna::io {

// Whether two edges of the loop that do not follow each other cross or touch in the projection along its area
// vector. True if the loop has no area vector. Cost: a sort, and the pairs whose boxes overlap along one
// axis.
bool crosses_itself(std::span<const Eigen::Vector3d> loop);

// Whether two triangles without a common vertex pass through each other or overlap in one plane. Two with a
// common edge intersect if they are folded onto each other. Triangles that touch within rounding do not
// count. Cost: as above.
bool has_intersections(const LidMesh& mesh);

}  // namespace lacuna::io
