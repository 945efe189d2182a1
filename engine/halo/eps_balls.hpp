// SPDX-License-Identifier: Apache-2.0
// Neighbourhoods of a given radius: the radius as a length, the number of points, and whether they fit in
// memory.
#pragma once

#include "engine/config/config.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>

#include <Eigen/Geometry>

namespace lacuna {

// Returns the largest distance between two points within the bounds; 0 without any point.
double extent_of(const Eigen::AlignedBox3d& bounds);

// Returns the radius as a length, for a scan of this extent; 0: off.
double eps_length(const NeighbourhoodConfig& config, double extent);

// Returns bytes for the neighbourhoods of a tile's points within eps. The result is no less than they take.
// The boxes of cells give about twice as many. Bytes are not counted further than `most`. Returns 0 if eps is
// 0.
std::uint64_t ball_bytes(const Tiling& tiling, const Tile& tile, double eps, std::uint64_t most);

// Returns the largest `ball_bytes` that one tile may have.
std::uint64_t most_ball_bytes(const Memory& memory);

// Throws `Error` where the neighbourhoods of one tile cannot fit in memory, before any is searched.
void refuse_balls(const Tiling& tiling, double eps, const Workers& workers);

}  // namespace lacuna
