// SPDX-License-Identifier: Apache-2.0
// halo: finds the points of other tiles that a tile needs, and the edges to them.
#pragma once

#include "engine/config/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/tile_store.hpp"

#include <span>

namespace lacuna {

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
