#include "engine/evaluate/kept_outputs.hpp"

#include "engine/workspace/workspace.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// With more, a stop would lose more; with less, there would be too many files. A part may take longer in a
// run that has taken long.
constexpr std::uint64_t kPartBytes = std::uint64_t{256} << 20;
constexpr std::chrono::seconds kLeastAge{10};
constexpr int kPartsOfRun = 64;

fs::path part_path(const fs::path& prefix, std::size_t number) {
  return prefix.string() + std::to_string(number);
}

// The numbers of the parts that there are.
std::set<std::size_t> part_numbers(const fs::path& prefix) {
  const std::string name = prefix.filename().string();
  std::set<std::size_t> numbers;
  for (const fs::path& file : workspace_files(prefix.parent_path())) {
    const std::string other = file.filename().string();
    if (other.starts_with(name) && !file.has_extension())
      numbers.insert(std::stoul(other.substr(name.size())));
  }
  return numbers;
}

}  // namespace

KeptOutputs::KeptOutputs(std::size_t level, std::size_t tiles, const std::string& made_from, const Job& job)
    : made_from_(digest_of(made_from)), has_(tiles) {
  if (job.kept.empty()) return;
  prefix_ = job.kept / ("tiles-" + std::to_string(level) + "-");
  for (const std::size_t number : part_numbers(prefix_)) {
    next_ = number + 1;
    if (std::optional<PartReader> part = PartReader::open(part_path(prefix_, number), made_from_)) {
      for (const std::uint64_t tile : part->keys()) has_.at(tile) = 1;
      parts_.push_back(*std::move(part));
    } else {
      remove_part(part_path(prefix_, number));
    }
  }
}

std::size_t KeptOutputs::count() const {
  return static_cast<std::size_t>(std::count(has_.begin(), has_.end(), 1));
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
    TileOutput output;
    for (const std::string& stream : part->streams(tile)) output.add(stream, part->bytes(stream, tile));
    visit(static_cast<TileIndex>(tile), output);
  });
}

void KeptOutputs::add(TileIndex tile, const TileOutput& output) {
  if (prefix_.empty()) return;
  const std::lock_guard lock(mutex_);
  if (!writer_) {
    writer_.emplace(part_path(prefix_, next_++));
    begun_ = Clock::now();
  }
  output.for_each_stream(
      [&](std::string_view stream, std::span<const std::byte> bytes) { writer_->add(stream, tile, bytes); });
  const Clock::time_point now = Clock::now();
  const Clock::duration most_age = std::max<Clock::duration>(kLeastAge, (now - start_) / kPartsOfRun);
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
