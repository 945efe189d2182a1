// SPDX-License-Identifier: Apache-2.0
// track_all: follows each hole through the levels, and finds how sure it is that each loop surrounds a hole
// (method.md, D).
#pragma once

#include "engine/run/job.hpp"
#include "engine/track/confidence.hpp"
#include "engine/track/level_loops.hpp"
#include "engine/track/near_loops.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// A loop of any level, and what the levels say of it.
struct TrackedLoop {
  std::uint32_t level, loop;  // the number within the level
  std::uint32_t first, last;  // levels of the track
  TrackEvidence evidence;
  double log_odds = 0;
};

// Returns all loops, level by level, in their order there: as `near_loops` numbers them. `pairs`: the result
// of `near_loops`. Cost: one pass over the loops' points.
std::vector<TrackedLoop> track_all(std::span<const LevelLoops> levels, std::span<const NearLoops> pairs,
                                   Job& job);

}  // namespace lacuna
