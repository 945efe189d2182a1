// SPDX-License-Identifier: Apache-2.0
// A level in a workspace that is kept: its store, and all else that the steps behind it need.
#pragma once

#include "engine/evaluate/kept_outputs.hpp"
#include "engine/levels/level.hpp"
#include "engine/run/job.hpp"
#include "engine/store/tile_store.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace lacuna {

// Empty files for a store: of a level, with names where the workspace is kept; or of this run alone.
StoreFiles level_files(std::size_t number, const Job& job);
StoreFiles temporary_files(const Job& job);

// Seals a level whose store is finished, and sets its `evaluation`. Does nothing where no workspace is kept.
void seal_level(Level& level, const std::string& made_from, const Job& job);

// None where the level is not there, is damaged, or was made from something else. Neither where its tiles do
// not fit in memory.
std::optional<Level> open_level(std::size_t number, const std::string& made_from, const Job& job);

// The level of a workspace, whatever the levels below it were made from. None as for `open_level`.
std::optional<Level> find_level(std::size_t number, const Job& job);

// How the run before an update has cut the scan into tiles, and has put tiles together for a level. None
// where there was none.
std::optional<TileGuide> find_guide(const Job& job);
std::optional<TileJoin> find_join(std::size_t number, const Job& job);

// The outputs of the level's tiles that are sealed already, and those of the run before an update.
KeptOutputs find_outputs(const Level& level, PartReader::Check check, const Job& job);

}  // namespace lacuna
