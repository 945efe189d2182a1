// SPDX-License-Identifier: Apache-2.0
// Every tile of a level evaluated, or taken from the workspace.
#pragma once

#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/levels/level.hpp"
#include "engine/run/job.hpp"

#include <functional>
#include <span>

namespace lacuna {

// Which tiles of a level one of several processes evaluates: the tiles' points are shared out evenly.
struct TaskShare {
  std::size_t task = 0, tasks = 1;
};

// take(tile, output) for every tile, from several threads at once, whether it was kept or is evaluated now.
// Returns the sums over all of them.
using TakeOutput = std::function<void(TileIndex, const TileOutput&)>;
Totals evaluate_level(const Level& level, std::span<TileConsumer* const> consumers, Job& job,
                      const TakeOutput& take);

// Evaluates those tiles of a share that the workspace does not have.
void evaluate_share(const Level& level, const TaskShare& share, std::span<TileConsumer* const> consumers,
                    Job& job);

}  // namespace lacuna
