// SPDX-License-Identifier: Apache-2.0
#include "engine/kept_state.hpp"

#include "engine/level_steps.hpp"
#include "engine/model/tiling.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/scan_steps.hpp"

#include <algorithm>
#include <set>
#include <system_error>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

bool is_column(const fs::path& file) {
  return file.stem().has_extension();
}

// Calls visit(part) for each whole part of a step, and counts the others.
template <class Visit>
void for_each_part(std::span<const fs::path> files, const std::string& step, std::size_t& damaged,
                   Visit&& visit) {
  for (const fs::path& file : files) {
    if (!is_of_step(file, step) || is_column(file)) continue;
    try {
      const std::optional<PartReader> part = PartReader::open(file, std::nullopt);
      part ? visit(*part) : void(++damaged);
    } catch (const DamagedFile&) {
      ++damaged;
    }
  }
}

}  // namespace

std::optional<KeptState> state_of(const fs::path& folder) {
  const std::vector<fs::path> files = kept_files(folder);
  if (files.empty()) return std::nullopt;
  KeptState state{.made_from = made_from_of(folder).value_or(std::vector<std::string>{})};
  for (const fs::path& file : files) {
    std::error_code error;
    if (const std::uintmax_t bytes = fs::file_size(file, error); !error) state.bytes += bytes;
  }
  const TaskPlan plan = read_plan(folder).value_or(TaskPlan());
  for (std::size_t number = 0; number < kMostLevels; ++number) {
    LevelState level{.number = number};
    std::set<std::uint64_t> evaluated;
    const std::string points = step_of_level(kLevel, number);
    std::vector<fs::path> shares;  // of the plan: an earlier one may have left others
    for (std::size_t task = 0; task < plan.tasks_of_level(number); ++task) {
      const fs::path share = part_file(folder, points, std::to_string(task));
      if (std::ranges::count(files, share) > 0) shares.push_back(share);
    }
    for_each_part(shares, points, state.damaged, [&](const PartReader& part) {
      const std::vector<Tile> tiles = part.records<Tile>("tiles");
      level.tiles += tiles.size();
      for (const Tile& tile : tiles) level.points += tile.points;
    });
    for_each_part(files, step_of_level(kEvaluate, number), state.damaged, [&](const PartReader& part) {
      for (const std::uint64_t tile : part.keys()) evaluated.insert(tile);
    });
    for_each_part(files, step_of_level(kLoops, number), state.damaged,
                  [&](const PartReader&) { level.has_loops = true; });
    level.evaluated = evaluated.size();
    if (level.tiles + level.evaluated > 0) state.levels.push_back(level);
  }
  return state;
}

}  // namespace lacuna
