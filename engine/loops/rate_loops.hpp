// SPDX-License-Identifier: Apache-2.0
// rate_loops: collects the evidence of each loop that its level has (method.md, D.3).
#pragma once

#include "engine/loops/loops.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/tile_store.hpp"

namespace lacuna {

// Adds the evidence that the curves do not have, but not the persistence, which tracking finds. `points`: of
// the level. Cost: linear in the points of loops, and
// `prominence` of the holes that it could make probable.
void rate_loops(const TileStore& points, Loops& loops, const Spill& spill, const Workers& workers);

}  // namespace lacuna
