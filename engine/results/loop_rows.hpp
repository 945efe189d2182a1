// SPDX-License-Identifier: Apache-2.0
// loop_rows: finds where the loops of all levels pass in the store of the first one.
#pragma once

#include "engine/loops/loops.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/rows.hpp"
#include "engine/store/tile_store.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace lacuna {

inline constexpr std::int32_t kNotReported = INT32_MAX;

// A point that is coherent or belongs to the boundary.
struct MarkedPoint : ScanPoint {
  static constexpr std::uint32_t kCoherent = 1, kBoundary = 2;

  LocalIndex owned;   // in its tile
  std::int32_t loop;  // the first reported loop through it; kNotReported: none
  float probability;  // of a point on a loop: at the level of the loop
  std::uint32_t marks;

  std::int32_t reported_loop() const { return loop == kNotReported ? -1 : loop; }
  bool is_coherent() const { return (marks & kCoherent) != 0; }
  bool is_boundary() const { return (marks & kBoundary) != 0; }

  friend bool operator<(const MarkedPoint& a, const MarkedPoint& b) { return a.id < b.id; }
};

struct LoopRows {
  AppendLists<MarkedPoint> points;  // by tile; once for each loop through a point
  RowSet rows;
};

// `selected`: the loops that are reported, ascending. The points of a loop are input points, at whatever
// level it was found. So each point is found by its place and its id. Cost: one pass over the tiles that have
// such points.
LoopRows find_loop_rows(const ChosenLoops& loops, std::span<const std::size_t> selected,
                        const TileStore& store, const Spill& spill, const TaskArena& arena);

}  // namespace lacuna
