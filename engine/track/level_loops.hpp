// SPDX-License-Identifier: Apache-2.0
// The loops of one level, as tracking takes them.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/levels/level.hpp"
#include "engine/loops/placed_loops.hpp"
#include "engine/run/job.hpp"

#include <cstdint>
#include <vector>

namespace lacuna {

struct LevelLoops {
  double edge = 0;           // of the level's lattice; 0: every point
  double cell_edge = 0;      // of the lattice on which its loops are compared with others
  std::uint64_t points = 0;  // distinct ones of the level
  double surface_area = 0;   // as its points sample it
  PlacedLoops loops;
  std::vector<LoopEvidence> evidence;  // of each loop
};

// Nothing else of the level is needed from then on.
LevelLoops level_loops(const Level& level, const Totals& totals, const FoundLoops& found,
                       const BoundaryMethod& boundary, Job& job);

}  // namespace lacuna
