// SPDX-License-Identifier: Apache-2.0
// A level in a workspace: its store, and all else that the steps behind it need. Several tasks may make it
// together, each a part with a run of its tiles.
#pragma once

#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"
#include "engine/thin/level.hpp"
#include "engine/workspace/kept_outputs.hpp"
#include "engine/workspace/workspace.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace lacuna {

// Returns empty files for the store of a level. They have names where the workspace is kept.
StoreFiles level_files(std::size_t number, const Workspace& workspace, const Job& job);
// Returns empty files for the store of this run alone.
StoreFiles temporary_files(const Job& job);

// Seals the part of a level that a task has made, and sets its `seal`. Does nothing where no workspace is
// kept.
void seal_part(Level& part, const TaskShare& share, const std::string& made_from, const Workspace& workspace,
               const Job& job);

// Returns whether a task has sealed its part.
bool has_part(std::size_t number, const TaskShare& share, const std::string& made_from,
              const Workspace& workspace, const Job& job);

// Joins the parts of a level. Returns nothing where one is not there, is damaged, was made from something
// else, or where its tiles do not fit in memory.
std::optional<Level> open_level(std::size_t number, const std::string& made_from, const Workspace& workspace,
                                const Job& job);

// Opens the level of a workspace, whatever the levels below it were made from. Otherwise as `open_level`.
std::optional<Level> find_level(std::size_t number, const Workspace& workspace, const Job& job);

// Returns what the level above is made from.
std::string made_from(const Level& below, const Config& config);

// Returns the sealed outputs of the level's tiles. Returns nothing where no workspace is kept.
std::optional<KeptOutputs> find_outputs(const Level& level, const Workspace& workspace, const Config& config);

}  // namespace lacuna
