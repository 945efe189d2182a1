// SPDX-License-Identifier: Apache-2.0
// The steps of a run from the first level on that other processes may do, too (unit.hpp). Each step takes
// from the workspace what is already there.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/evaluate/totals.hpp"
#include "engine/model/points.hpp"
#include "engine/run/job.hpp"
#include "engine/thin/level.hpp"
#include "engine/workspace/workspace.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace lacuna {

// Thins the points of a level to the level above. Returns nothing where too few are left for a hole.
std::optional<Level> level_above(const Level& below, const Totals& totals, const Workspace& workspace,
                                 Job& job);
// Makes a task's part of the level above. Returns nothing where the level has too few points.
std::optional<Level> thin_level(const Level& below, const Totals& totals, const TaskShare& share,
                                const Workspace& workspace, Job& job);

// Makes the outputs of a task's tiles of a level: halo, evaluate.
TileOutputs evaluate_level(const Level& level, std::span<const TileConsumer> consumers,
                           const Workspace& workspace, Job& job, const TaskShare& share = {});

}  // namespace lacuna
