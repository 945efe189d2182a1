// SPDX-License-Identifier: Apache-2.0
// thin: makes a level on a lattice from the points of the level below, without the input. It writes the chosen
// points of a store to a store of their own.
#pragma once

#include "engine/config/config.hpp"
#include "engine/config/job.hpp"
#include "engine/model/length_bins.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/thin/choose_points.hpp"
#include "engine/thin/level.hpp"

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

// Thins all points of a scan to the first level that the config's resolution or smallest hole wants. Throws
// `Error` where too few points are left to have neighbours.
Level thin_to_first(const Level& all, StoreFiles files, Job& job);

// Returns the edge of the level above: the first power of sqrt 2 that leaves about six in ten points. So
// lattices do not depend on the scan. It is 0 where no point has a neighbour. `distances`: mean distances to
// the neighbours, of all points of the level below.
double edge_above(const Level& below, const LengthBins& distances);

// Makes a task's share of the level above, with one point for each cell of a lattice.
Level thin_above(const Level& below, const TaskShare& share, double edge, StoreFiles files, Job& job);

// A level of fewer points leaves no interior around a hole, and is none.
inline constexpr std::uint64_t kFewestOfLevel = 200;

// Returns whether a run with this config has levels above the first one. It has them unless the config names
// one level, or the method is the paper's.
bool has_levels(const Config& config);

}  // namespace lacuna
