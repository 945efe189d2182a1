// SPDX-License-Identifier: Apache-2.0
#include "engine/workspace/workspace_state.hpp"

#include "engine/model/tiling.hpp"
#include "engine/store/sealed_part.hpp"
#include "engine/thin/thin.hpp"
#include "engine/workspace/workspace.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <system_error>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

struct LevelParts {
  std::vector<Tile> tiles;
  std::set<std::uint64_t> evaluated;
};

struct Sealed {
  fs::file_time_type time;
  bool is_output = false;
};

// How long tiles were evaluated. What lies between two parts is work, unless it is much longer than usual.
double seconds_of_outputs(std::vector<Sealed> parts) {
  constexpr double kPause = 5;  // times as long
  std::sort(parts.begin(), parts.end(), [](const Sealed& a, const Sealed& b) { return a.time < b.time; });
  std::vector<double> times;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (parts[i].is_output)
      times.push_back(std::chrono::duration<double>(parts[i].time - parts[i - 1].time).count());
  }
  if (times.empty()) return 0;
  std::sort(times.begin(), times.end());
  const double usual = times[times.size() / 2];
  double seconds = 0;
  for (const double time : times) seconds += std::min(time, kPause * usual);
  return seconds;
}

// The levels above the last one together have as many points as that. The steps behind the evaluation take
// about half as long (bench/NOTES.md).
std::optional<double> seconds_left(const std::vector<LevelState>& levels, double seconds, bool has_more) {
  constexpr double kStepsBehind = 1.5;
  std::uint64_t done = 0, left = 0;
  for (const LevelState& level : levels) {
    done += level.evaluated_points;
    left += level.points - level.evaluated_points;
  }
  if (has_more && left > 0) left += levels.back().points;
  if (done == 0 || left == 0 || seconds == 0) return std::nullopt;
  return kStepsBehind * seconds * static_cast<double>(left) / static_cast<double>(done);
}

}  // namespace

std::optional<WorkspaceState> state_of_workspace(const fs::path& folder) {
  const std::vector<fs::path> files = workspace_files(folder);
  if (files.empty()) return std::nullopt;
  WorkspaceState state{.made_from = made_from_of(folder).value_or(std::vector<std::string>{}),
                       .is_update = !workspace_files(earlier_parts(folder)).empty()};
  std::map<std::size_t, LevelParts> levels;
  std::vector<Sealed> sealed;
  for (const fs::path& file : files) {
    std::error_code error;
    if (const std::uintmax_t bytes = fs::file_size(file, error); !error) state.bytes += bytes;
    const std::optional<std::size_t> of_points = level_of_part(file), of_tiles = level_of_outputs(file);
    const std::optional<PartReader> part =
        of_points || of_tiles ? PartReader::open(file, std::nullopt, PartReader::Check::kTable)
                              : std::nullopt;
    if (!part) continue;
    sealed.push_back({fs::last_write_time(file, error), of_tiles.has_value()});
    if (of_points) {
      levels[*of_points].tiles = part->records<Tile>("tiles", 0);
    } else {
      const std::vector<std::uint64_t> tiles = part->keys();
      levels[*of_tiles].evaluated.insert(tiles.begin(), tiles.end());
    }
  }
  for (const auto& [number, parts] : levels) {
    LevelState& level = state.levels.emplace_back();
    level = {.number = number, .tiles = parts.tiles.size(), .evaluated = parts.evaluated.size()};
    for (std::uint64_t t = 0; t < parts.tiles.size(); ++t) {
      level.points += parts.tiles[t].points;
      if (parts.evaluated.contains(t)) level.evaluated_points += parts.tiles[t].points;
    }
  }
  // Without the part of the run, how many levels there will be is not known.
  if (!state.levels.empty() && is_of_this_program(state.made_from))
    state.seconds_left = seconds_left(state.levels, seconds_of_outputs(std::move(sealed)),
                                      has_levels(read_run(folder).config));
  return state;
}

}  // namespace lacuna
