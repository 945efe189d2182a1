// SPDX-License-Identifier: Apache-2.0
#include "engine/parts/level_form.hpp"

#include "engine/bucket/split.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/survey/survey.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iomanip>
#include <span>
#include <sstream>
#include <utility>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr const char *kPoints = ".points", *kNormals = ".normals";

// The numbers of a level, as the part has them.
struct LevelNumbers {
  std::uint64_t number;
  SurveyTotals survey;
  double extent, edge;
  std::uint64_t tile_points, has_normals;
  std::uint64_t represented;  // lists; 0: no lists
  std::uint64_t points_bytes, normals_bytes;
  Digest points_digest, normals_digest;  // of the digests of all tiles
};

std::optional<AppendLists<Represented>> represented_of(std::uint64_t lists, const PartReader& part,
                                                       const Spill& spill) {
  if (lists == 0) return std::nullopt;
  AppendLists<Represented> represented(spill, "represented", lists);
  for (std::uint64_t list = 0; list < lists; ++list) {
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

bool fits(const Tiling& tiling, const Config& config, const Memory& memory) {
  return std::all_of(tiling.tiles.begin(), tiling.tiles.end(),
                     [&](const Tile& tile) { return tile_bytes(tile.points, config) <= memory.tiles; });
}

fs::path column(const LevelForm& form, const std::string& digits, const char* kind) {
  return form.parts.folder / (form.step + "-" + digits + kind + ".lacuna");
}

// Columns have the names of their content: two processes that make the same level do each other no harm.
fs::path column_of(const LevelForm& form, const Digest& digest, const char* kind) {
  std::ostringstream digits;
  digits << std::hex << std::setfill('0') << std::setw(16) << digest[0];
  return column(form, digits.str(), kind);
}

// Removes what a level of one share replaces: its columns, and shares of an earlier plan.
void remove_replaced(const LevelForm& form, const fs::path& points, const fs::path& normals) {
  const fs::path part = part_file(form.parts.folder, form.step, "0");
  for (const fs::path& file : kept_files(form.parts.folder)) {
    const bool is_own = file == part || file == points || file == normals;
    if (is_of_step(file, form.step) && !is_own && file.extension() != kUnsealed) remove_kept(file);
  }
}

}  // namespace

std::optional<Level> LevelForm::read(const PartReader& part) const {
  const auto numbers = part.record<LevelNumbers>("level");
  Tiling tiling;
  tiling.tiles = part.records<Tile>("tiles");
  tiling.cells = part.records<Cell>("cells");
  tiling.build_tree();
  if (!fits(tiling, job.config, job.workers.memory)) return std::nullopt;
  std::optional<StoreFile> points =
      open_file(column_of(*this, numbers.points_digest, kPoints), numbers.points_bytes);
  std::optional<StoreFile> normals =
      open_file(column_of(*this, numbers.normals_digest, kNormals), numbers.normals_bytes);
  if (!points || !normals) return std::nullopt;
  AppendLists<Duplicate> duplicates(job.spill, "duplicates", tiling.tiles.size());
  for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
    part.for_each<Duplicate>("duplicates", t,
                             [&](std::span<const Duplicate> some) { duplicates.append(t, some); });
  }
  TileStore store(
      {PointColumn(std::move(*points), numbers.survey.precision()), Column<PlainNormal>(std::move(*normals))},
      numbers.has_normals != 0, std::move(tiling), std::move(duplicates),
      part.records<TileDigests>("digests"));
  return Level{.number = numbers.number,
               .edge = numbers.edge,
               .survey = numbers.survey,
               .extent = numbers.extent,
               .tile_points = numbers.tile_points,
               .store = std::move(store),
               .seal = line_of(part.checksum()),
               .input = part.records<std::uint64_t>("input"),
               .represented = represented_of(numbers.represented, part, job.spill)};
}

void LevelForm::write(Level& level, PartWriter& part) const {
  StoreFile &points = level.store.points_file(), &normals = level.store.normals_file();
  points.start_sync();
  normals.start_sync();
  const Tiling& tiling = level.store.tiling();
  std::vector<TileDigests> digests(tiling.tiles.size());
  job.workers.arena.for_each(
      digests.size(), [&](std::size_t t) { digests[t] = level.store.digests(static_cast<TileIndex>(t)); });
  Hash of_points, of_normals;
  for (const TileDigests& tile : digests) {
    of_points.add(std::as_bytes(std::span(tile.points)));
    of_normals.add(std::as_bytes(std::span(tile.normals)));
  }
  const LevelNumbers numbers{.number = level.number,
                             .survey = level.survey,
                             .extent = level.extent,
                             .edge = level.edge,
                             .tile_points = level.tile_points,
                             .has_normals = level.store.has_normals(),
                             .represented = level.represented ? level.represented->lists() : 0,
                             .points_bytes = points.size(),
                             .normals_bytes = normals.size(),
                             .points_digest = of_points.digest(),
                             .normals_digest = of_normals.digest()};
  const fs::path points_path = column_of(*this, numbers.points_digest, kPoints);
  const fs::path normals_path = column_of(*this, numbers.normals_digest, kNormals);
  points.seal(points_path);
  normals.seal(normals_path);
  if (!parts.is_unit && parts.plan.tasks_of_level(level.number) == 1)
    remove_replaced(*this, points_path, normals_path);

  part.add_one("level", numbers);
  part.add("tiles", tiling.tiles);
  part.add("digests", digests);
  part.add("cells", tiling.cells);
  for (TileIndex t = 0; t < tiling.tiles.size(); ++t) {
    add_in_blocks<Duplicate>(part, "duplicates", t,
                             [&](auto&& visit) { level.store.for_each_duplicate(t, visit); });
  }
  part.add("input", level.input);
  for (std::uint64_t list = 0; list < numbers.represented; ++list) {
    add_in_blocks<Represented>(part, "represented", list,
                               [&](auto&& visit) { level.represented->for_each(list, visit); });
  }
}

StoreFiles LevelForm::files() const {
  if (!parts.are_kept()) return temporary_store(job.spill);
  const auto create = [&](const char* kind) {
    return StoreFile(column(*this, random_digits(), kind).string() + kUnsealed, StoreFile::Name::kKept);
  };
  return {create(kPoints), create(kNormals), job.spill};
}

StoreFiles temporary_store(const Spill& spill) {
  return {StoreFile(spill.file("points")), StoreFile(spill.file("normals")), spill};
}

Level join_levels(std::vector<Level> shares, const Spill& spill) {
  Level level = std::move(shares.front());
  if (shares.size() == 1) return level;
  std::vector<TileStore> stores;
  stores.push_back(std::move(level.store));
  for (std::size_t i = 1; i < shares.size(); ++i) {
    stores.push_back(std::move(shares[i].store));
    level.seal += shares[i].seal;
  }
  level.store = TileStore::joined(std::move(stores), spill);
  return level;
}

}  // namespace lacuna
