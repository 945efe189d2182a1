// SPDX-License-Identifier: Apache-2.0
// Polygons seen from above.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

using Ring2 = std::vector<Eigen::Vector2d>;  // closed; its first corner is not repeated

// A place is inside where a ray from it crosses an odd number of edges, of all rings. So the order of rings
// and their directions do not count.
using PlanPolygon = std::vector<Ring2>;

}  // namespace lacuna::io
