// SPDX-License-Identifier: Apache-2.0
// store: writes the chosen points of a store to a store of their own.
#pragma once

#include "engine/run/parallel.hpp"
#include "engine/store/store_writer.hpp"
#include "engine/thin/choose_points.hpp"

#include <cstdint>
#include <vector>

namespace lacuna {

// The way in which tiles of the store below are put together.
struct TileJoin {
  std::vector<TileIndex> first;   // of each tile, its first tile below; it has all up to the next one's first
  std::uint64_t tile_points = 0;  // the most in a tile, where none below has more
  std::uint64_t cell_points = 0;  // the most in a cell, where none below has more
};

// Joins the tiles from which points were chosen. A node of the tree over them becomes one tile if it has at
// most `tile_points` chosen points.
TileJoin join_tiles(const Tiling& below, const ChosenPoints& chosen, std::uint64_t tile_points,
                    std::uint64_t cell_points);

// Stores the chosen points in the order that they have below, so that nothing is sorted. Cost: reads all
// points below once.
TileStore store_chosen(const TileStore& below, const ChosenPoints& chosen, const TileJoin& join,
                       StoreFiles files, const Workers& workers);

}  // namespace lacuna
