// SPDX-License-Identifier: Apache-2.0
// prominence: how far a hole stands out of the gaps of the sampling around it (method.md, D.3).
#pragma once

#include "engine/loops/loops.hpp"
#include "engine/loops/measure_loop.hpp"
#include "engine/store/scratch.hpp"
#include "engine/store/tile_store.hpp"

#include <span>

namespace lacuna {

// Returns the largest distance from a place within the hole to a point, over the gap of the sampling around
// it. Nine in ten places around the hole are nearer to a point than the gap. Distances are those in the plane
// of the loop, on a raster. The result is 1 for a gap like those around it, and 0 for a loop that encloses
// nothing. `points`: of the level; `spacing`: along the loop. Cost: the points in the box of the hole and its
// surroundings, and at most 65,536 pixels.
double prominence(const TileStore& points, std::span<const LoopPoint> loop, const LoopShape& shape,
                  double spacing, Scratch& scratch);

}  // namespace lacuna
