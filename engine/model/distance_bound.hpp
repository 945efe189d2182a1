// SPDX-License-Identifier: Apache-2.0
// Bounds on the distance to the k-th neighbour. They follow from the counted cells alone.
#pragma once

#include "engine/model/tiling.hpp"

#include <cstdint>
#include <functional>

namespace lacuna {

// Returns a squared upper bound of the distance from any point of the cell to its k-th nearest neighbour. The
// cells that lie wholly within the bound hold more than k points. The bound is infinite where the scan has no
// more than k points. Cost: the cells near by, logarithmic in the number of all.
double squared_distance_bound(const Tiling& tiling, std::uint32_t cell, std::size_t k);

// Calls visit(cell) for every cell that may hold a point within `squared_radius` of a point of `box`, in
// store order. It passes over cells [skip_first, skip_last), and stops when visit returns false.
void for_each_cell_near(const Tiling& tiling, const Eigen::AlignedBox3d& box, double squared_radius,
                        std::uint32_t skip_first, std::uint32_t skip_last,
                        const std::function<bool(std::uint32_t)>& visit);

}  // namespace lacuna
