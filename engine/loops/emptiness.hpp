// SPDX-License-Identifier: Apache-2.0
// emptiness: how much of the space over a hole is empty (method.md, D.3).
//
// The lid of a loop is a surface with this loop as its boundary. It stands for the surface that a hole lacks.
#pragma once

#include "engine/loops/loops.hpp"
#include "engine/loops/measure_loop.hpp"
#include "engine/store/scratch.hpp"
#include "engine/store/tile_store.hpp"

#include <span>

namespace lacuna {

// Compares places on the lid: their mean distance to the nearest point, over the one to the nearest point of
// the loop. It is 1 where nothing lies in the hole, and 0 where the loop encloses nothing. Places on a
// surface as dense as the loop, such as an island, do not count. `points`: of the level; `spacing`: along the
// loop. Cost: the loop's points times the places, and a search for the nearest point at each place.
double emptiness(const TileStore& points, std::span<const LoopPoint> loop, const LoopShape& shape,
                 double spacing, Scratch& scratch);

}  // namespace lacuna
