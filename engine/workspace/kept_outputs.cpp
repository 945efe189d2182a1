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

constexpr std::string_view kContent = "content";  // the stream of the fingerprint

}  // namespace

KeptOutputs::KeptOutputs(std::size_t level, std::size_t tiles, const std::string& made_from,
                         const std::string& earlier, PartReader::Check check, const Workspace& workspace)
    : level_(level),
      folder_(workspace.folder),
      earlier_folder_(workspace.earlier),
      made_from_(digest_of(made_from)),
      check_(check),
      part_of_(tiles),
      earlier_part_of_(tiles),
      least_age_(workspace.is_unit ? kLeastAgeOfUnit : kLeastAge) {
  find_parts(workspace.is_unit);
  if (!earlier.empty()) find_earlier_parts(digest_of(earlier));
}

// The parts of the level in a folder.
std::vector<fs::path> KeptOutputs::files_of(const fs::path& folder) const {
  std::vector<fs::path> files = workspace_files(folder);
  std::erase_if(files, [&](const fs::path& file) { return level_of_outputs(file) != level_; });
  return files;
}

// Removes parts that are damaged or made from something else. A unit removes none.
void KeptOutputs::find_parts(bool is_unit) {
  for (const fs::path& file : files_of(folder_)) {
    std::optional<PartReader> part = PartReader::open(file, made_from_, check_);
    const auto is_tile = [&](std::uint64_t tile) { return tile < part_of_.size(); };
    if (part && std::ranges::all_of(part->keys(), is_tile)) {
      const auto shared = std::make_shared<const PartReader>(*std::move(part));
      for (const std::uint64_t tile : shared->keys()) part_of_[tile] = shared;
    } else if (!is_unit) {
      remove_part(file);
    }
  }
}

void KeptOutputs::find_earlier_parts(const Digest& made_from) {
  for (const fs::path& file : files_of(earlier_folder_)) {
    std::optional<PartReader> part = PartReader::open(file, made_from);
    if (!part) continue;
    const auto shared = std::make_shared<const PartReader>(*std::move(part));
    for (const std::uint64_t tile : shared->keys()) {
      if (tile < earlier_part_of_.size()) earlier_part_of_[tile] = shared;
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

void KeptOutputs::add(TileIndex tile, const Digest& content, std::span<const Stream> streams) {
  std::vector<Stream> all = {{kContent, std::as_bytes(std::span(content))}};
  all.insert(all.end(), streams.begin(), streams.end());
  write(tile, all);
}

bool KeptOutputs::add_earlier(TileIndex tile, const Digest& content) {
  const PartReader* const part = earlier_part_of_[tile].get();
  if (part == nullptr || part->records<Digest>(kContent, tile) != std::vector{content}) return false;
  std::vector<std::vector<std::byte>> bytes;
  std::vector<Stream> streams;
  const std::vector<std::string> names = part->streams(tile);
  for (const std::string& name : names) {
    bytes.push_back(part->records<std::byte>(name, tile));
    streams.push_back({name, bytes.back()});
  }
  write(tile, streams);
  return true;
}

void KeptOutputs::write(TileIndex tile, std::span<const Stream> streams) {
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
  std::optional<PartReader> part = PartReader::open(open_path_, made_from_, PartReader::Check::kTable);
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
