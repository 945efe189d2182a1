// SPDX-License-Identifier: Apache-2.0
// The steps of a level: its points, their evaluation, and its loops.
#pragma once

#include "engine/consumers.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/evaluate/totals.hpp"
#include "engine/model/task_share.hpp"
#include "engine/scan_steps.hpp"
#include "engine/thin/level.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>

namespace lacuna {

inline constexpr std::string_view kEvaluate = "evaluate", kLoops = "loops";

// A task's share of the level above, thinned from the level below. Returns nothing where the level below has
// too few points. Where the share is made, a level below without distances is evaluated.
std::optional<Level> share_of_level_above(const Level& below, const StepContext& context, std::size_t task);
// The level above, all of it. Returns nothing where too few points are left for a hole.
std::optional<Level> level_above(const Level& below, const StepContext& context);
// A level by its number, 0 for the first one. Makes what is not kept of the levels below.
std::optional<Level> level_of_number(std::size_t number, const StepContext& context);

// The outputs of a task's tiles of a level: halo, evaluate.
TileOutputs evaluate_level(const Level& level, std::span<const TileConsumer> consumers,
                           const StepContext& context, const TaskShare& share = {});

// What is found in the boundary graph of a level.
struct FoundLevel {
  Totals totals;
  FoundLoops boundary;
};
// Boundary edges, stitch, loops. `outputs` is called where the loops are not kept.
FoundLevel loops_of_level(const Level& level, BoundaryMethod& method,
                          const std::function<const TileOutputs&()>& outputs, const StepContext& context);

}  // namespace lacuna
