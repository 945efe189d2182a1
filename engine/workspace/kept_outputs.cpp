// SPDX-License-Identifier: Apache-2.0
#include "engine/workspace/kept_outputs.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <string>
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

KeptOutputs::KeptOutputs(std::size_t level, std::size_t tiles, const std::string& made_from,
                         const Workspace& workspace)
    : level_(level),
      folder_(workspace.folder),
      made_from_(digest_of(made_from)),
      part_of_(tiles),
      least_age_(workspace.is_unit ? kLeastAgeOfUnit : kLeastAge) {
  find_parts(workspace.is_unit);
}

// Removes parts that are damaged or made from something else. A unit removes none.
void KeptOutputs::find_parts(bool is_unit) {
  for (const fs::path& file : workspace_files(folder_)) {
    if (level_of_outputs(file) != level_) continue;
    std::optional<PartReader> part = PartReader::open(file, made_from_);
    const auto is_tile = [&](std::uint64_t tile) { return tile < part_of_.size(); };
    if (part && std::ranges::all_of(part->keys(), is_tile)) {
      const auto shared = std::make_shared<const PartReader>(*std::move(part));
      for (const std::uint64_t tile : shared->keys()) part_of_[tile] = shared;
    } else if (!is_unit) {
      remove_part(file);
    }
  }
}

std::vector<TileIndex> KeptOutputs::missing() const {
  std::vector<TileIndex> missing;
  for (TileIndex t = 0; t < part_of_.size(); ++t) {
    if (part_of_[t] == nullptr) missing.push_back(t);
  }
  return missing;
}

void KeptOutputs::add(TileIndex tile, std::span<const Stream> streams) {
  const std::lock_guard lock(*mutex_);
  if (!open_) {
    open_path_ = tiles_prefix(folder_, level_).string() + random_digits();
    open_.emplace(open_path_);
    begun_ = Clock::now();
  }
  for (const Stream& stream : streams) open_->add(stream.name, tile, stream.bytes);
  const Clock::time_point now = Clock::now();
  const Clock::duration most_age = std::max<Clock::duration>(least_age_, (now - start_) / kPartsOfRun);
  if (open_->bytes() >= kPartBytes || now - begun_ >= most_age) seal();
}

void KeptOutputs::finish() {
  const std::lock_guard lock(*mutex_);
  if (open_) seal();
}

void KeptOutputs::seal() {
  open_->seal(made_from_);
  open_.reset();
  std::optional<PartReader> part = PartReader::open(open_path_, made_from_);
  if (!part) throw Error(open_path_.string() + ": the file was changed during the run");
  const auto shared = std::make_shared<const PartReader>(*std::move(part));
  for (const std::uint64_t tile : shared->keys()) part_of_[tile] = shared;
}

std::uint64_t KeptOutputs::size(std::string_view stream, TileIndex tile) const {
  return part_of_[tile]->size(stream, tile);
}

void KeptOutputs::read(std::string_view stream, TileIndex tile, std::span<std::byte> to) const {
  part_of_[tile]->read(stream, tile, to);
}

}  // namespace lacuna
