// SPDX-License-Identifier: Apache-2.0
// The loops of one level, each point joined with what the evaluation found of it. From then on, nothing else
// of the level is needed.
#pragma once

#include "engine/loops/loop_points.hpp"
#include "engine/loops/measure_loop.hpp"
#include "engine/loops/raw_loops.hpp"
#include "engine/model/loop.hpp"
#include "engine/run/job.hpp"
#include "engine/store/column.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna {

// In order of (first id, length, ids).
struct PlacedLoops {
  Column<StoredLoopPoint> points;            // loop after loop
  std::vector<std::uint64_t> offsets = {0};  // loops + 1

  std::size_t size() const { return offsets.size() - 1; }
  std::uint64_t count(std::size_t loop) const { return offsets[loop + 1] - offsets[loop]; }
  // In the order of the loop, in blocks: it may be larger than memory.
  void for_each_point(std::size_t loop, const std::function<void(const StoredLoopPoint&)>& visit) const;
};

// Loops of several levels that stand, in order of (first id, length, ids), and what tracking found of each.
struct TrackedLoops {
  PlacedLoops loops;
  std::vector<LoopTrack> tracks;
};

PlacedLoops place_loops(const RawLoops& loops, const LoopPointLists& points, const Tiling& tiling, Job& job);

// visit(i, points, scratch) for each loop, from several threads. Memory: a share of the limit, whatever the
// length of a loop.
void for_each_loop(const PlacedLoops& loops, Job& job,
                   const std::function<void(std::size_t, std::span<const StoredLoopPoint>, Scratch&)>& visit);

}  // namespace lacuna
