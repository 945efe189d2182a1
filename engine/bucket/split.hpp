// SPDX-License-Identifier: Apache-2.0
// split: orders the counted cells as a kd-tree and cuts them into tiles. How many points tiles and cells have
// follows from the memory that they take.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/cell_grid.hpp"
#include "engine/model/tiling.hpp"
#include "engine/run/parallel.hpp"
#include "engine/survey/survey.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna {

// Returns the points per tile: as the config has it, or enough tiles for all threads. They are never fewer
// or more than memory allows. Throws `Error` where so many points can never fit.
std::uint64_t points_per_tile(std::uint64_t points, const Config& config, const Workers& workers);
// Returns the points in a cell of the index, so that all cells fit in memory.
std::uint64_t points_per_cell(std::uint64_t points, const Memory& memory);
// Returns the bytes that a tile with so many points takes while it is evaluated.
std::uint64_t tile_bytes(std::uint64_t points, const Config& config);

// The numbers of a plan, as plain data.
struct PlanTotals {
  CellGrid grid;
  std::uint64_t far_points = 0;   // which are set aside, since they are far from almost all others
  std::uint64_t points = 0;       // finite ones of the scan
  std::uint64_t tile_points = 0;  // the most that a tile may hold
  std::uint64_t cell_points = 0;  // the most in a cell of the index
};

// Where points go while they are bucketed.
struct TilePlan : PlanTotals {
  std::vector<CountedCell> cells;  // in the order of the tree, tile after tile
  std::vector<Tile> tiles;         // tiles of these cells; their rows begin where all copies would fit
  std::vector<CountedCell> heavy;  // cells that are set aside for more points than a tile may hold

  // The groups of points that are set aside: each heavy cell, and then all far points.
  std::size_t groups() const { return heavy.size() + (far_points > 0); }
  std::uint64_t group_points(std::size_t group) const;  // or more, where a cell has `kMostCounted`
  // Returns a number no less than the number of tiles in the end.
  std::uint64_t most_tiles() const;
};

// Halves the cells along the longest side of their box, at the point count's median. A run that holds at most
// `tile_points` points becomes a tile. Halving goes on below, down to few cells, so that cells near in the
// order are near in space. Far points are set aside: they would widen the boxes of all runs. Consumes the
// survey's cells. Cost: n log n in cells.
TilePlan split_tiles(SurveyedScan& survey, std::uint64_t tile_points);

}  // namespace lacuna
