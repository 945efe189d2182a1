// SPDX-License-Identifier: Apache-2.0
// track_all: each hole followed through the levels, and how sure it is that each loop surrounds one
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

// All loops, level by level, in their order there: as `near_loops` numbers them. `pairs`: from it. Cost: one
// pass over the loops' points.
std::vector<TrackedLoop> track_all(std::span<const LevelLoops> levels, std::span<const NearLoops> pairs,
                                   Job& job);

}  // namespace lacuna
