// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/kept_outputs.hpp"

#include "engine/workspace/workspace.hpp"

#include <algorithm>
#include <utility>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// With more, a stop would lose more; with less, there would be too many files. A part may take longer in a
// run that has taken long. Units of a run are many, and each loses its own tiles only.
constexpr std::uint64_t kPartBytes = std::uint64_t{256} << 20;
constexpr std::chrono::seconds kLeastAge{10}, kLeastAgeOfUnit{300};
constexpr int kPartsOfRun = 64;

}  // namespace

KeptOutputs::KeptOutputs(std::size_t level, const Tiling& tiling, const std::string& made_from,
                         const std::string& earlier, PartReader::Check check, const Job& job)
    : level_(level),
      tiling_(tiling),
      made_from_(digest_of(made_from)),
      has_(tiling.tiles.size()),
      earlier_of_(tiling.tiles.size()),
      least_age_(job.is_unit ? kLeastAgeOfUnit : kLeastAge) {
  if (job.kept.empty()) return;
  prefix_ = tiles_prefix(job.kept, level);
  for (const fs::path& file : files_of(job.kept)) {
    std::optional<PartReader> part = PartReader::open(file, made_from_, check);
    const auto is_tile = [&](std::uint64_t tile) { return tile < has_.size(); };
    if (part && std::ranges::all_of(part->keys(), is_tile)) {
      for (const std::uint64_t tile : part->keys()) has_[tile] = 1;
      parts_.push_back(*std::move(part));
    } else if (!job.is_unit) {
      remove_part(file);
    }
  }
  if (!earlier.empty()) find_earlier_parts(job.earlier, digest_of(earlier));
}

// The parts of the level in a folder.
std::vector<fs::path> KeptOutputs::files_of(const fs::path& folder) const {
  std::vector<fs::path> files = workspace_files(folder);
  std::erase_if(files, [&](const fs::path& file) { return level_of_outputs(file) != level_; });
  return files;
}

void KeptOutputs::find_earlier_parts(const fs::path& folder, const Digest& made_from) {
  for (const fs::path& file : files_of(folder)) {
    std::optional<PartReader> part = PartReader::open(file, made_from);
    if (!part) continue;
    earlier_.push_back(*std::move(part));
    for (const std::uint64_t tile : earlier_.back().keys()) {
      if (tile < earlier_of_.size()) earlier_of_[tile] = earlier_.size();
    }
  }
}

std::optional<TileOutput> KeptOutputs::find_earlier(TileIndex tile, const Digest& content) const {
  if (earlier_of_[tile] == 0) return std::nullopt;
  TileOutput output(earlier_[earlier_of_[tile] - 1], tile, tiling_);
  if (output.content() != content) return std::nullopt;
  return output;
}

std::vector<TileIndex> KeptOutputs::missing() const {
  std::vector<TileIndex> missing;
  for (TileIndex t = 0; t < has_.size(); ++t) {
    if (has_[t] == 0) missing.push_back(t);
  }
  return missing;
}

void KeptOutputs::for_each(const Job& job,
                           const std::function<void(TileIndex, const TileOutput&)>& visit) const {
  struct Place {
    const PartReader* part;
    std::uint64_t tile;
  };
  std::vector<Place> places;
  std::vector<std::uint64_t> needs;
  std::vector<std::uint8_t> is_listed(has_.size());  // two copies of a tile are the same
  for (const PartReader& part : parts_) {
    for (const std::uint64_t tile : part.keys()) {
      if (std::exchange(is_listed[tile], std::uint8_t{1}) != 0) continue;
      places.push_back({&part, tile});
      needs.push_back(part.size(tile));
    }
  }
  job.arena.for_each_within_budget(needs, job.memory.tiles, [&](std::size_t i) {
    const auto& [part, tile] = places[i];
    visit(static_cast<TileIndex>(tile), TileOutput(*part, tile, tiling_));
  });
}

void KeptOutputs::add(TileIndex tile, const TileOutput& output) {
  if (prefix_.empty()) return;
  const std::lock_guard lock(mutex_);
  if (!writer_) {
    writer_.emplace(prefix_.string() + random_digits());
    begun_ = Clock::now();
  }
  output.for_each_stored(tiling_, [&](std::string_view stream, std::span<const std::byte> bytes) {
    writer_->add(stream, tile, bytes);
  });
  const Clock::time_point now = Clock::now();
  const Clock::duration most_age = std::max<Clock::duration>(least_age_, (now - start_) / kPartsOfRun);
  if (writer_->bytes() >= kPartBytes || now - begun_ >= most_age) seal();
}

void KeptOutputs::finish() {
  const std::lock_guard lock(mutex_);
  if (writer_) seal();
}

void KeptOutputs::seal() {
  writer_->seal(made_from_);
  writer_.reset();
}

}  // namespace lacuna
