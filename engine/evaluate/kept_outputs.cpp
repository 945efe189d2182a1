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

KeptOutputs::KeptOutputs(std::size_t level, std::size_t tiles, const std::string& made_from, const Job& job)
    : made_from_(digest_of(made_from)), has_(tiles), least_age_(job.is_unit ? kLeastAgeOfUnit : kLeastAge) {
  if (job.kept.empty()) return;
  prefix_ = tiles_prefix(job.kept, level);
  for (const fs::path& file : workspace_files(job.kept)) {
    if (!file.string().starts_with(prefix_.string()) || file.has_extension()) continue;
    // A unit needs to know only which tiles there are.
    std::optional<PartReader> part = PartReader::open(
        file, made_from_, job.is_unit ? PartReader::Check::kTable : PartReader::Check::kWhole);
    if (part) {
      for (const std::uint64_t tile : part->keys()) has_.at(tile) = 1;
      parts_.push_back(*std::move(part));
    } else if (!job.is_unit) {
      remove_part(file);
    }
  }
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
    visit(static_cast<TileIndex>(tile), TileOutput(*part, tile));
  });
}

void KeptOutputs::add(TileIndex tile, const TileOutput& output) {
  if (prefix_.empty()) return;
  const std::lock_guard lock(mutex_);
  if (!writer_) {
    writer_.emplace(prefix_.string() + random_digits());
    begun_ = Clock::now();
  }
  output.for_each_stream(
      [&](std::string_view stream, std::span<const std::byte> bytes) { writer_->add(stream, tile, bytes); });
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
