// SPDX-License-Identifier: Apache-2.0
// Finds what a workspace has of a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lacuna {

struct LevelState {
  std::size_t number = 0;    // from 0
  std::uint64_t points = 0;  // distinct ones
  std::size_t tiles = 0;     // 0: the level's points are not all there
  std::size_t evaluated = 0;
};

struct WorkspaceState {
  std::vector<std::string> made_from;  // a line each
  std::vector<LevelState> levels;
  std::uint64_t bytes = 0;  // of all files
};

// Reads the tables of the parts, and does not check that the parts are whole. Returns nothing where the
// folder is no workspace.
std::optional<WorkspaceState> state_of_workspace(const std::filesystem::path& folder);

}  // namespace lacuna
