// SPDX-License-Identifier: Apache-2.0
// halo: finds the points of other tiles that a tile needs, and the edges to them. With a given radius,
// neighbourhoods are refused where they do not fit in memory.
#pragma once

#include "engine/config/config.hpp"
#include "engine/config/job.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <span>

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

// A halo point, and the edge to it. The owner of the edge's other point receives it.
struct HaloEdge {
  Row row;  // of the foreign point
  ScanPoint foreign;
  LocalIndex owned;
  std::uint32_t incoming;  // 1: the foreign point has the owned one among its k nearest; 0: the other way
};

// Returns the inboxes of `tiles`; the inboxes of other tiles stay empty. With its inbox, a tile knows
// every foreign point that is among the k nearest of its own, or the reverse. It need not read a halo for
// this.
//
// Only points whose neighbourhood may leave their tile take part: points of cells whose distance bound
// touches a foreign cell. Their exact neighbours are searched among all cells within that bound, so the halo
// is complete. The bound of a lone outlier holds too many points. Its neighbours are searched cell by cell,
// nearest cell first.
AppendLists<HaloEdge> exchange_halo(const TileStore& store, std::span<const TileIndex> tiles, Job& job);

}  // namespace lacuna
