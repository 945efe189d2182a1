// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lacuna::peers {

using Triangle = std::array<std::size_t, 3>;  // ids of points, all triangles turning the same way
using Loop = std::vector<std::size_t>;

// Returns the border of a mesh as simple loops. The function chains half-edges without an opposite one, and
// cuts a chain where it passes a vertex a second time. It leaves out a chain with an open end, as at
// triangles that do not turn the same way. Cost: O(n log n) for n triangles. The same triangles give the same
// loops.
std::vector<Loop> border_loops(std::span<const Triangle> triangles);

}  // namespace lacuna::peers
