// SPDX-License-Identifier: Apache-2.0
// track: the same hole through the levels, how sure it is one, and which of its loops stands (method.md, D).
#pragma once

#include "engine/loops/loops.hpp"
#include "engine/run/job.hpp"
#include "engine/track/level_loops.hpp"

#include <vector>

namespace lacuna {

// The loops that stand, and what tracking found of each.
struct TrackedLoops {
  ChosenLoops loops;
  std::vector<LoopTrack> tracks;
};

// For each hole the loop that stands, if it is as sure as the config wants. `levels`: from fine to coarse.
// The choice does not depend on what is wanted, so a higher confidence gives a subset. The paper's loops, of
// one level, all stand. Cost: a sort of the loops' cells on disk.
TrackedLoops track_loops(std::vector<LevelLoops> levels, Job& job);

}  // namespace lacuna
