// SPDX-License-Identifier: Apache-2.0
#include "engine/workspace/sealed_level.hpp"

#include "engine/store/sealed_part.hpp"
#include "engine/survey/survey.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iomanip>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr const char *kPoints = ".points", *kNormals = ".normals";

// The numbers of a part of a level, as the part has them.
struct LevelNumbers {
  SurveyTotals survey;
  double extent, edge;
  std::uint64_t parts;
  std::uint64_t tile_points, has_normals;
  std::uint64_t represented;  // lists; 0: no lists
  std::uint64_t points_bytes, normals_bytes;
  Digest points_digest, normals_digest;  // of the digests of all tiles
};

LevelNumbers numbers_of(const Level& level, const TaskShare& share) {
  return {.survey = level.survey,
          .extent = level.extent,
          .edge = level.edge,
          .parts = share.tasks,
          .tile_points = level.tile_points,
          .has_normals = level.store.has_normals(),
          .represented = level.represented ? level.represented->lists() : 0};
}

Tiling tiling_of(const PartReader& part) {
  Tiling tiling;
  tiling.tiles = part.records<Tile>("tiles", 0);
  tiling.cells = part.records<Cell>("cells", 0);
  return tiling;
}

std::optional<AppendLists<Represented>> represented_of(const LevelNumbers& numbers, const PartReader& part,
                                                       const Job& job) {
  if (numbers.represented == 0) return std::nullopt;
  AppendLists<Represented> represented(job.file("represented"), numbers.represented, job.lists);
  for (std::uint64_t list = 0; list < numbers.represented; ++list) {
    part.for_each<Represented>("represented", list,
                               [&](std::span<const Represented> some) { represented.append(list, some); });
  }
  return represented;
}

// Opens a file that is as long as it was sealed.
std::optional<StoreFile> open_file(const fs::path& path, std::uint64_t bytes) {
  std::optional<StoreFile> file = StoreFile::open_sealed(path);
  if (file && file->size() != bytes) return std::nullopt;
  return file;
}

std::optional<LevelNumbers> record_of(const PartReader& part) {
  const std::vector<LevelNumbers> records = part.records<LevelNumbers>("level", 0);
  if (records.size() != 1) return std::nullopt;
  return records.front();
}

bool fits(const Tiling& tiling, const Job& job) {
  return std::all_of(tiling.tiles.begin(), tiling.tiles.end(),
                     [&](const Tile& tile) { return job.tile_bytes(tile.points) <= job.memory.tiles; });
}

fs::path part_path(std::size_t number, std::size_t task, const Workspace& workspace) {
  return level_prefix(workspace.folder, number).string() + std::to_string(task);
}

// Columns have the names of their content: two processes that make the same level do each other no harm.
fs::path column_of(std::size_t number, const Digest& digest, const char* extension,
                   const Workspace& workspace) {
  std::ostringstream name;
  name << level_prefix(workspace.folder, number).string() << std::hex << std::setfill('0') << std::setw(16)
       << digest[0] << extension;
  return name.str();
}

// Removes the columns of parts of a level that are replaced.
void remove_other_columns(Level& level, const Workspace& workspace) {
  for (const fs::path& file : workspace_files(workspace.folder)) {
    if (level_of_column(file) == level.number && file != level.store.points_file().path() &&
        file != level.store.normals_file().path())
      remove_part(file);
  }
}

std::optional<PartReader> open_part(std::size_t number, const TaskShare& share, const std::string& made_from,
                                    const Workspace& workspace) {
  return PartReader::open(part_path(number, share.task, workspace), digest_of(made_from, share));
}

// Returns how many tasks have made a level. Whether they have made it from the right data, each part says.
std::size_t count_parts(std::size_t number, const Workspace& workspace) {
  const std::optional<PartReader> part = PartReader::open(part_path(number, 0, workspace), std::nullopt);
  const std::optional<LevelNumbers> record = part ? record_of(*part) : std::nullopt;
  return record ? record->parts : 1;
}

std::optional<Level> read_part(std::size_t number, const TaskShare& share, const std::string& made_from,
                               const Workspace& workspace, const Job& job) {
  const std::optional<PartReader> part = open_part(number, share, made_from, workspace);
  if (!part) return std::nullopt;
  const std::optional<LevelNumbers> numbers = record_of(*part);
  if (!numbers) return std::nullopt;
  const LevelNumbers& record = *numbers;
  Tiling tiling = tiling_of(*part);
  if (!fits(tiling, job)) return std::nullopt;
  std::optional<StoreFile> points =
      open_file(column_of(number, record.points_digest, kPoints, workspace), record.points_bytes);
  std::optional<StoreFile> normals =
      open_file(column_of(number, record.normals_digest, kNormals, workspace), record.normals_bytes);
  if (!points || !normals) return std::nullopt;
  TileStore store({std::move(*points), std::move(*normals), job.file("duplicates")}, std::move(tiling),
                  part->records<TileDigests>("digests", 0), record.survey.precision(),
                  record.has_normals != 0, job.lists);
  for (TileIndex t = 0; t < store.tiling().tiles.size(); ++t)
    part->for_each<Duplicate>(
        "duplicates", t, [&](std::span<const Duplicate> duplicates) { store.add_duplicates(t, duplicates); });
  return Level{.number = number,
               .edge = record.edge,
               .survey = record.survey,
               .extent = record.extent,
               .tile_points = record.tile_points,
               .store = std::move(store),
               .seal = line_of(part->checksum()),
               .input = part->records<std::uint64_t>("input", 0),
               .represented = represented_of(record, *part, job)};
}

Level join(std::vector<Level> parts, const Job& job) {
  std::vector<TileStore> stores;
  std::string seal;
  for (Level& part : parts) {
    stores.push_back(std::move(part.store));
    seal += part.seal;
  }
  Level level = std::move(parts.front());
  level.store = TileStore::joined(std::move(stores), job.file("duplicates"), job.lists);
  level.seal = std::move(seal);
  return level;
}

}  // namespace

StoreFiles level_files(std::size_t number, const Workspace& workspace, const Job& job) {
  if (!workspace.is_kept()) return temporary_files(job);
  const auto create = [&](const char* extension) {
    return StoreFile(
        level_prefix(workspace.folder, number).string() + random_digits() + extension + kUnsealed,
        StoreFile::Name::kKept);
  };
  return {create(kPoints), create(kNormals), job.file("duplicates")};
}

StoreFiles temporary_files(const Job& job) {
  return {StoreFile(job.file("points")), StoreFile(job.file("normals")), job.file("duplicates")};
}

void seal_part(Level& level, const TaskShare& share, const std::string& made_from, const Workspace& workspace,
               const Job& job) {
  if (!workspace.is_kept()) return;
  LevelNumbers record = numbers_of(level, share);
  StoreFile &points = level.store.points_file(), &normals = level.store.normals_file();
  points.start_sync();
  normals.start_sync();
  const Tiling& tiling = level.store.tiling();
  std::vector<TileDigests> digests(tiling.tiles.size());
  job.arena.for_each(digests.size(),
                     [&](std::size_t t) { digests[t] = level.store.digests(static_cast<TileIndex>(t)); });
  Hash of_points, of_normals;
  for (const TileDigests& tile : digests) {
    of_points.add(std::as_bytes(std::span(tile.points)));
    of_normals.add(std::as_bytes(std::span(tile.normals)));
  }
  record.points_bytes = points.size();
  record.normals_bytes = normals.size();
  record.points_digest = of_points.digest();
  record.normals_digest = of_normals.digest();
  points.seal(column_of(level.number, record.points_digest, kPoints, workspace));
  normals.seal(column_of(level.number, record.normals_digest, kNormals, workspace));

  PartWriter part(part_path(level.number, share.task, workspace));
  part.add("level", 0, std::span<const LevelNumbers>(&record, 1));
  part.add("tiles", 0, std::span<const Tile>(tiling.tiles));
  part.add("digests", 0, std::span<const TileDigests>(digests));
  part.add("cells", 0, std::span<const Cell>(tiling.cells));
  for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
    add_in_blocks<Duplicate>(part, "duplicates", t,
                             [&](auto&& visit) { level.store.for_each_duplicate(t, visit); });
  }
  part.add("input", 0, std::span<const std::uint64_t>(level.input));
  for (std::uint64_t list = 0; list < record.represented; ++list) {
    add_in_blocks<Represented>(part, "represented", list,
                               [&](auto&& visit) { level.represented->for_each(list, visit); });
  }
  level.seal = line_of(part.seal(digest_of(made_from, share)));
  if (!workspace.is_unit && share.tasks == 1) remove_other_columns(level, workspace);
}

bool has_part(std::size_t number, const TaskShare& share, const std::string& made_from,
              const Workspace& workspace, const Job& job) {
  return read_part(number, share, made_from, workspace, job).has_value();
}

std::optional<Level> open_level(std::size_t number, const std::string& made_from, const Workspace& workspace,
                                const Job& job) {
  if (!workspace.is_kept()) return std::nullopt;
  std::vector<Level> parts;
  const std::size_t tasks = count_parts(number, workspace);
  for (std::size_t task = 0; task < tasks; ++task) {
    std::optional<Level> part = read_part(number, {task, tasks}, made_from, workspace, job);
    if (!part) return std::nullopt;
    parts.push_back(*std::move(part));
  }
  return join(std::move(parts), job);
}

std::optional<Level> find_level(std::size_t number, const Workspace& workspace, const Job& job) {
  std::string from = workspace.made_from;
  for (std::size_t below = 0; below < number; ++below) {
    const std::size_t tasks = count_parts(below, workspace);
    std::string seal;
    for (std::size_t task = 0; task < tasks; ++task) {
      const std::optional<PartReader> part = open_part(below, {task, tasks}, from, workspace);
      if (!part) return std::nullopt;
      seal += line_of(part->checksum());
    }
    from = seal + evaluation_parameters(job.config);
  }
  return open_level(number, from, workspace, job);
}

std::string made_from(const Level& below, const Config& config) {
  return below.seal + evaluation_parameters(config);
}

std::optional<KeptOutputs> find_outputs(const Level& level, const Workspace& workspace,
                                        const Config& config) {
  if (!workspace.is_kept()) return std::nullopt;
  // Levels above the first one have only the outputs of their loops.
  const std::string wanted = level.number == 0 ? output_parameters(config) : "";
  return std::optional<KeptOutputs>(std::in_place, level.number, level.store.tiling().tiles.size(),
                                    made_from(level, config) + wanted, workspace);
}

}  // namespace lacuna
