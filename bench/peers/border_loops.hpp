// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lacuna::peers {

using Triangle = std::array<std::size_t, 3>;  // ids of points, all triangles turning the same way
using Loop = std::vector<std::size_t>;

// Returns the border of a mesh as simple loops. Half-edges without an opposite one are chained. A chain is
// cut where it passes a vertex a second time. A chain that ends nowhere, as at triangles that do not turn the
// same way, is left out. O(n log n) for n triangles; the same triangles give the same loops.
std::vector<Loop> border_loops(std::span<const Triangle> triangles);

}  // namespace lacuna::peers
