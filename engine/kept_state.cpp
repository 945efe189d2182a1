// SPDX-License-Identifier: Apache-2.0
#include "engine/kept_state.hpp"

#include "engine/level_steps.hpp"
#include "engine/model/tiling.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/scan_steps.hpp"

#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <system_error>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// Adds a part of a step to what is known of its level.
void add(const PartReader& part, std::string_view step, LevelState& level,
         std::set<std::uint64_t>& evaluated) {
  if (step == kLevel) {
    const std::vector<Tile> tiles = part.records<Tile>("tiles");
    level.tiles += tiles.size();
    for (const Tile& tile : tiles) level.points += tile.points;
  } else if (step == kEvaluate) {
    for (const std::uint64_t tile : part.keys()) evaluated.insert(tile);
  } else if (step == kLoops) {
    level.has_loops = true;
  }
}

}  // namespace

std::optional<KeptState> state_of(const fs::path& folder) {
  const std::vector<fs::path> files = kept_files(folder);
  if (files.empty()) return std::nullopt;
  KeptState state{.made_from = made_from_of(folder).value_or(std::vector<std::string>{})};
  static const std::regex of_level("([a-z]+)-([0-9]{1,3})-([0-9a-f]{1,16})\\.lacuna");  // and no column
  const TaskPlan plan = read_plan(folder).value_or(TaskPlan());
  std::map<std::size_t, LevelState> levels;
  std::map<std::size_t, std::set<std::uint64_t>> evaluated;
  for (const fs::path& file : files) {
    std::error_code error;
    if (const std::uintmax_t bytes = fs::file_size(file, error); !error) state.bytes += bytes;
    const std::string name = file.filename().string();
    std::smatch words;
    if (!std::regex_match(name, words, of_level)) continue;
    const std::string step = words.str(1);
    const std::size_t number = std::stoul(words.str(2));
    // An earlier plan of more tasks may have left shares.
    const std::size_t task = std::strtoull(words.str(3).c_str(), nullptr, 10);
    if (step == kLevel && task >= plan.tasks_of_level(number)) continue;
    try {
      const std::optional<PartReader> part = PartReader::open(file, std::nullopt);
      part ? add(*part, step, levels[number], evaluated[number]) : void(++state.damaged);
    } catch (const DamagedFile&) {
      ++state.damaged;
    }
  }
  for (auto& [number, level] : levels) {
    level.number = number;
    level.evaluated = evaluated[number].size();
    if (level.tiles + level.evaluated > 0) state.levels.push_back(level);
  }
  return state;
}

}  // namespace lacuna
