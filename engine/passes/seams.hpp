// The stars of points that wait for other tiles.
#pragma once

#include "engine/passes/evaluate.hpp"

namespace lacuna {

// Finds the stars of border points once all points have their seats, measures these and the ones beside them,
// and goes on, from tile to tile, to look for rough points along refused triangles until there are no more:
// then all gaps are known. Consumes all but the gaps.
void settle_seams(StarLists& lists, const Tiling& tiling, Job& job);

}  // namespace lacuna
