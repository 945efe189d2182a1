// Loops measured: the points of each joined with what the evaluation said of them.
#pragma once

#include "engine/loops/loop_points.hpp"
#include "engine/loops/measure_loop.hpp"
#include "engine/loops/raw_loops.hpp"
#include "engine/model/loop.hpp"
#include "engine/run/job.hpp"
#include "engine/store/column.hpp"
#include "engine/store/tile_store.hpp"

#include <functional>
#include <vector>

namespace lacuna {

// All loops that are sure enough, in order of (first id, length, ids).
struct MeasuredLoops {
  Column<StoredLoopPoint> points;      // loop after loop
  std::vector<std::uint64_t> offsets;  // loops + 1
  std::vector<LoopMeasures> measures;

  // In the order of the loop, in blocks: it may be larger than memory.
  void for_each_point(std::size_t loop, const std::function<void(const StoredLoopPoint&)>& visit) const;
};

// Memory: a share of the limit, whatever the length of a loop. `mean_edge_length` sets the lattice of
// LoopMeasures::tiles.
MeasuredLoops measure_loops(const RawLoops& loops, const LoopPointLists& points, const Tiling& tiling,
                            double mean_edge_length, Job& job);

// The loops that the selection reports. All are sure enough.
std::vector<std::size_t> select_loops(const std::vector<LoopMeasures>& loops, const SelectionConfig& config);

}  // namespace lacuna
