// Links between tiles: who has whom among its nearest neighbours, across the border.
#pragma once

#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/tile_store.hpp"

namespace lacuna {

// To the owner of a point: a foreign point that belongs into its sight.
struct HaloEdge {
  Row row;  // of the foreign point
  StoredPoint foreign;
  LocalIndex owned;
  std::uint32_t incoming;  // 1: the foreign point has the owned one among its k nearest; 0: the other way
};

// Each tile's inbox. With it a tile knows every foreign point that is among the k nearest of its own or has
// one of its own among its k nearest, without reading a halo.
//
// Only points whose neighbourhood may leave their tile take part: those of cells whose reach touches a
// foreign cell. Their exact neighbours are searched among all cells within that reach, so no halo is taken
// on trust. Where the reach holds too many points (lone outliers, whose neighbours are far), a point's
// neighbours are found one cell after the other instead, nearest cell first.
AppendLists<HaloEdge> exchange_halo(const TileStore& store, Job& job);

}  // namespace lacuna
