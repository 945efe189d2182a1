// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/tile_outputs.hpp"

#include "engine/parts/kept_run.hpp"
#include "engine/run/error.hpp"

#include <algorithm>
#include <utility>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// Larger parts would lose more at a stop, and smaller ones would be too many files. A part may take longer in
// a run that has taken long. Units of a run are many, and each loses its own tiles only.
constexpr std::uint64_t kPartBytes = std::uint64_t{256} << 20;
constexpr std::chrono::seconds kLeastAge{10}, kLeastAgeOfUnit{300};
constexpr int kPartsOfRun = 64;

}  // namespace

TileOutputs::TileOutputs(const Tiling& tiling, const Parts& parts, PartKey key, const Spill& spill)
    : tiling_(&tiling), lists_(std::make_unique<AppendBytes>(spill, "outputs", 0)) {
  if (!parts.are_kept()) return;
  kept_.emplace();
  kept_->folder = parts.folder;
  kept_->key = std::move(key);
  kept_->least_age = parts.is_unit ? kLeastAgeOfUnit : kLeastAge;
  kept_->part_of.resize(tiling.tiles.size());
  kept_->find_parts(parts);
}

// Removes parts that are damaged or made from something else. A unit removes none.
void TileOutputs::Kept::find_parts(const Parts& parts) {
  for (const fs::path& file : kept_files(folder)) {
    if (!is_of_step(file, key.step) || file.extension() == kUnsealed || take(file) || parts.is_unit) continue;
    parts.progress->make_again(key.step);
    remove_kept(file);
  }
}

bool TileOutputs::Kept::take(const fs::path& file) {
  std::optional<PartReader> part = PartReader::open(file, key.text());
  const auto is_tile = [&](std::uint64_t tile) { return tile < part_of.size(); };
  if (!part || !std::ranges::all_of(part->keys(), is_tile)) return false;
  const auto shared = std::make_shared<const PartReader>(*std::move(part));
  for (const std::uint64_t tile : shared->keys()) part_of[tile] = shared;
  return true;
}

void TileOutputs::Kept::add(TileIndex tile, std::span<const TileOutput::Stream> streams) {
  if (!open) {
    open_path = part_file(folder, key.step, random_digits());
    open.emplace(open_path);
    begun = Clock::now();
  }
  for (const TileOutput::Stream& stream : streams) open->add(stream.name, tile, stream.bytes);
  const Clock::time_point now = Clock::now();
  if (open->bytes() >= kPartBytes ||
      now - begun >= std::max<Clock::duration>(least_age, (now - start) / kPartsOfRun))
    seal();
}

void TileOutputs::Kept::seal() {
  open->seal(key.text());
  open.reset();
  if (!take(open_path)) throw Error(open_path.string() + ": the file was changed during the run");
}

std::vector<TileIndex> TileOutputs::missing() const {
  std::vector<TileIndex> missing;
  for (TileIndex t = 0; t < tiling_->tiles.size(); ++t) {
    if (!kept_ || kept_->part_of[t] == nullptr) missing.push_back(t);
  }
  return missing;
}

void TileOutputs::add(TileIndex tile, const TileOutput& output) {
  if (kept_) {
    const std::lock_guard lock(*mutex_);
    kept_->add(tile, output.streams_);
  } else {
    for (const TileOutput::Stream& stream : output.streams_)
      lists_->append(make_list(stream.name, tile), stream.bytes);
  }
}

void TileOutputs::finish() {
  if (kept_ && kept_->open) kept_->seal();
}

std::size_t TileOutputs::list_of(std::string_view stream, TileIndex tile) const {
  const auto at = std::find(streams_.begin(), streams_.end(), stream);
  if (at == streams_.end()) return kUnknown;
  return static_cast<std::size_t>(at - streams_.begin()) * tiling_->tiles.size() + tile;
}

std::size_t TileOutputs::make_list(std::string_view stream, TileIndex tile) {
  const std::lock_guard lock(*mutex_);
  if (const std::size_t list = list_of(stream, tile); list != kUnknown) return list;
  streams_.push_back(stream);
  lists_->add_lists(tiling_->tiles.size());
  return list_of(stream, tile);
}

std::uint64_t TileOutputs::record_count(std::string_view stream, TileIndex tile,
                                        std::size_t record_bytes) const {
  const std::size_t list = list_of(stream, tile);
  const std::uint64_t bytes = kept_              ? kept_->part_of[tile]->size(stream, tile)
                              : list == kUnknown ? 0
                                                 : lists_->size(list);
  if (bytes % record_bytes != 0)
    fail_inconsistent("the stream " + std::string(stream) + " of a tile is not of whole records");
  return bytes / record_bytes;
}

void TileOutputs::read_bytes(std::string_view stream, TileIndex tile, std::span<std::byte> to) const {
  if (to.empty()) return;
  if (kept_) {
    kept_->part_of[tile]->read(stream, tile, to);
  } else {
    lists_->read(list_of(stream, tile), to.data());
  }
}

}  // namespace lacuna
