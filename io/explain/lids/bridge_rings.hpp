// SPDX-License-Identifier: Apache-2.0
// bridge_rings: makes one polygon of a loop and the islands in it, so that it can be triangulated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::io {

// A bridge is the shortest line between a point of the polygon and a point of an island. The polygon passes
// it in both directions, with the island between them, so it has the bridge's ends twice. Islands with
// shorter bridges come first. Each island runs against the loop, in whichever direction it is given.
//
// `points`: of the loop, then of the islands; `sizes`: their numbers of points. No point has two bridges.
// Returns indices of points, or nothing if there are too few points for the bridges. Ties: by order. Cost:
// the product of all points and the islands' points.
std::optional<std::vector<std::uint32_t>> bridge_rings(std::span<const Eigen::Vector3d> points,
                                                       std::span<const std::size_t> sizes);

}  // namespace lacuna::io
