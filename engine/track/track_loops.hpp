// SPDX-License-Identifier: Apache-2.0
// track: follows the same hole through the levels, and chooses one of its loops (method.md, D).
#pragma once

#include "engine/config/job.hpp"
#include "engine/loops/loops.hpp"
#include "engine/track/level_loops.hpp"

#include <vector>

namespace lacuna {

// The chosen loops, and what tracking found of each.
struct TrackedLoops {
  ChosenLoops loops;
  std::vector<LoopTrack> tracks;
};

// Returns the chosen loop of each hole, if its confidence is at least the selection's. select_loops applies
// the other limits. `levels`: from fine to coarse. The choice does not depend on what is wanted, so a higher
// confidence gives a subset. All loops of the paper, which has one level, are chosen. Cost: a sort of the
// loops' cells on disk.
TrackedLoops track_loops(std::vector<LevelLoops> levels, Job& job);

}  // namespace lacuna
