// SPDX-License-Identifier: Apache-2.0
// A level in a workspace: its store, and all else that the steps behind it need.
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

// Empty files for the store of a level, with names where the workspace is kept.
StoreFiles level_files(std::size_t number, const Workspace& workspace, const Job& job);
// Empty files for the store of this run alone.
StoreFiles temporary_files(const Job& job);

// Seals a level whose store is finished, and sets its `evaluation`. Does nothing where no workspace is kept.
void seal_level(Level& level, const std::string& made_from, const Workspace& workspace, const Job& job);

// Returns nothing where the level is not there, is damaged, was made from something else, or where its tiles
// do not fit in memory.
std::optional<Level> open_level(std::size_t number, const std::string& made_from, const Workspace& workspace,
                                const Job& job);

// The level of a workspace, whatever the levels below it were made from. Otherwise as `open_level`.
std::optional<Level> find_level(std::size_t number, const Workspace& workspace, const Job& job);

// How the run before an update has cut the scan into tiles. Nothing without an update, or where such tiles do
// not fit in memory.
std::optional<TileGuide> find_guide(const Workspace& workspace, const Job& job);
// How the run before an update has put tiles together for a level.
std::optional<TileJoin> find_join(std::size_t number, const Workspace& workspace);

// The outputs of the level's tiles that are sealed already, and those of the run before an update. Nothing
// where no workspace is kept.
std::optional<KeptOutputs> find_outputs(const Level& level, PartReader::Check check,
                                        const Workspace& workspace, const Config& config);

}  // namespace lacuna
