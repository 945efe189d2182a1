// SPDX-License-Identifier: Apache-2.0
// What a workspace has of a run, and how long the rest will take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lacuna {

struct LevelState {
  std::size_t number = 0;              // from 0
  std::uint64_t points = 0;            // distinct ones
  std::uint64_t evaluated_points = 0;  // of these
  std::size_t tiles = 0;               // 0: the level's points are not all there
  std::size_t evaluated = 0;           // tiles
};

struct WorkspaceState {
  std::vector<std::string> made_from;  // a line each
  std::vector<LevelState> levels;
  std::uint64_t bytes = 0;  // of all files
  bool is_update = false;   // which was stopped
  // As fast as the tiles were evaluated so far, pauses left out; none before there are a few parts, and for a
  // complete workspace.
  std::optional<double> seconds_left;
};

// Reads the tables of the parts, and not whether the parts are whole. None where the folder is no workspace.
std::optional<WorkspaceState> state_of_workspace(const std::filesystem::path& folder);

}  // namespace lacuna
