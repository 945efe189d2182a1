// SPDX-License-Identifier: Apache-2.0
// loop_rows: finds where the loops of all levels pass in the store of the first one.
#pragma once

#include "engine/loops/measure_loops.hpp"
#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/row_set.hpp"
#include "engine/store/tile_store.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace lacuna {

inline constexpr std::int32_t kNotReported = INT32_MAX;

struct PointOnLoop {
  LocalIndex owned;
  std::int32_t loop;  // the reported loop; kNotReported: the loop is not reported
  float probability;  // at the level of the loop
  StoredPoint point;
};

struct LoopRows {
  AppendLists<PointOnLoop> points;  // by tile; once for each loop through a point
  RowSet rows;
};

// `selected`: the loops that are reported, ascending. The points of a loop are input points, at whatever
// level it was found. So each point is found by its place and its id. Cost: one pass over the tiles that have
// such points.
LoopRows find_loop_rows(const ChosenLoops& loops, std::span<const std::size_t> selected,
                        const TileStore& store, Job& job);

}  // namespace lacuna
