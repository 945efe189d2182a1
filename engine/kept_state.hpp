// SPDX-License-Identifier: Apache-2.0
// Finds what a kept folder has of a run.
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
  bool has_loops = false;
};

struct KeptState {
  std::vector<std::string> made_from;  // input and parameters, a line each
  std::vector<LevelState> levels;
  std::uint64_t bytes = 0;  // of all files
  std::size_t damaged = 0;  // parts that are to be made again
};

// Reads the tables of the parts, and does not check that the parts are whole. Returns nothing where the
// folder keeps no run.
std::optional<KeptState> state_of(const std::filesystem::path& folder);

}  // namespace lacuna
