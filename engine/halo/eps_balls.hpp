// SPDX-License-Identifier: Apache-2.0
// Neighbourhoods of a given radius: its length, how many points they hold, and whether these fit in memory.
#pragma once

#include "engine/config/config.hpp"
#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>

#include <Eigen/Geometry>

namespace lacuna {

// The largest distance between two points within the bounds; 0 without any point.
double extent_of(const Eigen::AlignedBox3d& bounds);

// The radius as a length, for a scan of this extent; 0: off.
double eps_length(const NeighbourhoodConfig& config, double extent);

// Bytes for the neighbourhoods of a tile's points within eps: no less than they take, by the boxes of cells
// some twice as many. Not counted further than `most`. eps 0: none.
std::uint64_t ball_bytes(const Tiling& tiling, const Tile& tile, double eps, std::uint64_t most);

// What `ball_bytes` of one tile may be.
std::uint64_t most_ball_bytes(const Job& job);

// Throws `Error` where the neighbourhoods of one tile cannot fit in memory, before any is searched.
void refuse_balls(const Tiling& tiling, double eps, const Job& job);

}  // namespace lacuna
