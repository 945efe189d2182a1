// SPDX-License-Identifier: Apache-2.0
// evaluate, over the tiles of a level: evaluates every point from its neighbourhood (paper, 4.1 to 4.6).
#pragma once

#include "engine/config/job.hpp"
#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/halo/halo.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/thin/level.hpp"

#include <span>

namespace lacuna {

// Evaluates `tiles`, and adds what their consumers emit to `outputs`. Consumes the halo.
void evaluate_tiles(const Level& level, std::span<const TileIndex> tiles, AppendLists<HaloEdge> halo,
                    std::span<const TileConsumer> consumers, TileOutputs& outputs, Job& job);

}  // namespace lacuna
