// SPDX-License-Identifier: Apache-2.0
#include "engine/workspace/workspace_state.hpp"

#include "engine/model/tiling.hpp"
#include "engine/store/sealed_part.hpp"
#include "engine/thin/thin.hpp"
#include "engine/workspace/workspace.hpp"

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

}  // namespace

std::optional<WorkspaceState> state_of_workspace(const fs::path& folder) {
  const std::vector<fs::path> files = workspace_files(folder);
  if (files.empty()) return std::nullopt;
  WorkspaceState state{.made_from = made_from_of(folder).value_or(std::vector<std::string>{})};
  std::map<std::size_t, LevelParts> levels;
  for (const fs::path& file : files) {
    std::error_code error;
    if (const std::uintmax_t bytes = fs::file_size(file, error); !error) state.bytes += bytes;
    const std::optional<std::size_t> of_points = level_of_part(file), of_tiles = level_of_outputs(file);
    const std::optional<PartReader> part =
        of_points || of_tiles ? PartReader::open(file, std::nullopt) : std::nullopt;
    if (!part) continue;
    if (of_points) {
      try {
        const std::vector<Tile> tiles = part->records<Tile>("tiles", 0);
        std::vector<Tile>& all = levels[*of_points].tiles;
        all.insert(all.end(), tiles.begin(), tiles.end());
      } catch (const DamagedFile&) {
        continue;
      }
    } else {
      const std::vector<std::uint64_t> tiles = part->keys();
      levels[*of_tiles].evaluated.insert(tiles.begin(), tiles.end());
    }
  }
  for (const auto& [number, parts] : levels) {
    LevelState& level = state.levels.emplace_back();
    level = {.number = number, .tiles = parts.tiles.size(), .evaluated = parts.evaluated.size()};
    for (const Tile& tile : parts.tiles) level.points += tile.points;
  }
  return state;
}

}  // namespace lacuna
