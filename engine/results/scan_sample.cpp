#include "engine/results/scan_sample.hpp"

#include "engine/store/outbox.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

constexpr double kBoundaryWeight = 3;  // added to a weight of 1 at the probability 1

// Uniform in (0, 1), by the mixer of SplitMix64 (Steele, Lea, Flood, 2014).
double drawn_from(PointId id) {
  std::uint64_t bits = value(id) + 0x9e3779b97f4a7c15;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
  bits ^= bits >> 31;
  return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}

double key_of(PointId id, const Evaluation& e) {
  const double weight = e.mean_distance * e.mean_distance * (1 + kBoundaryWeight * e.probability);
  const double key = drawn_from(id) / weight;
  return key < std::numeric_limits<double>::max() ? key : std::numeric_limits<double>::max();
}

// Sixteen bins for each power of two: the order of positive numbers is that of their bits.
std::uint32_t bin_of(double key) {
  return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(key) >> 48);
}

}  // namespace

ScanSample::ScanSample(std::uint64_t most_points, std::uint64_t ids, const TileStore& store, const Job& job)
    : store_(store),
      most_points_(most_points),
      ids_(ids),
      candidates_(job.file("sample-keys"), 1, job.memory.spills / 8) {}

void ScanSample::emit(const EvaluatedTile& tile, TileOutput& output) const {
  std::vector<EmittedSample> samples;
  const std::uint32_t last = last_bin_;
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    const Evaluation& e = tile.evaluations[p];
    const double key = key_of(tile.points.ids[p], e);
    if (bin_of(key) > last) continue;
    const Eigen::Vector3f normal = e.normal.cast<float>();
    samples.push_back({key, tile.probability(p), {normal.x(), normal.y(), normal.z()}, p, 0});
  }
  output.add("sample", std::move(samples));
}

void ScanSample::absorb(TileIndex tile, const TileOutput& output) {
  std::vector<KeyedSample> samples;
  const std::span<const EmittedSample> emitted = output.read<EmittedSample>("sample");
  auto next = emitted.begin();
  LocalIndex point = 0;
  const std::uint32_t last = last_bin_;
  store_.for_each_point(tile, [&](const StoredPoint& p) {
    if (next == emitted.end() || next->point != point++) return;
    const auto& [key, probability, normal, place, padding] = *next++;
    if (bin_of(key) <= last) samples.push_back({key, {p, probability, {normal[0], normal[1], normal[2]}}});
  });
  const std::lock_guard lock(mutex_);
  std::erase_if(samples, [&](const KeyedSample& sample) { return bin_of(sample.key) > last_bin_; });
  candidates_.append(0, samples);
  for (const KeyedSample& sample : samples) ++bins_[bin_of(sample.key)];
  binned_ += samples.size();
  // A bin goes where those before it are enough.
  while (!bins_.empty() && binned_ - bins_.rbegin()->second >= most_points_) {
    binned_ -= bins_.rbegin()->second;
    bins_.erase(std::prev(bins_.end()));
  }
  if (binned_ >= most_points_) last_bin_ = bins_.rbegin()->first;
}

// The largest rank in the sample. Only those of the last bin are to be ordered.
ScanSample::Rank ScanSample::last_rank(Job& job) const {
  Rank last{std::numeric_limits<double>::infinity(), PointId{0}};
  if (binned_ < most_points_) return last;
  SortedRuns<Rank> of_last_bin(job.file("sample-ranks"), job.memory.spills / 8);
  candidates_.for_each(0, [&](const KeyedSample& candidate) {
    if (bin_of(candidate.key) == last_bin_) of_last_bin.add(rank_of(candidate));
  });
  std::uint64_t taken = binned_ - of_last_bin.size();  // all of the bins before
  of_last_bin.for_each([&](const Rank& rank) {
    if (taken++ < most_points_) last = rank;
  });
  return last;
}

Column<StoredSample> ScanSample::finish(Job& job) {
  Phase phase(job, "sample", binned_);
  constexpr std::uint64_t kBlock = 1 << 16;  // ids: a block is sorted in memory
  AppendLists<StoredSample> blocks(job.file("sample-blocks"), ids_ / kBlock + 1, job.memory.spills / 8);
  Outbox<StoredSample> outbox(blocks);
  const Rank last = last_rank(job);
  candidates_.for_each(0, [&](const KeyedSample& candidate) {
    const StoredSample& sample = candidate.sample;
    if (rank_of(candidate) <= last)
      outbox.add(static_cast<TileIndex>(value(sample.point.id) / kBlock), sample);
  });
  outbox.send();
  std::vector<std::uint64_t> first_rows(blocks.lists()), needs(blocks.lists());
  std::uint64_t row = 0;
  for (std::size_t b = 0; b < blocks.lists(); ++b) {
    first_rows[b] = row;
    row += blocks.count(b);
    needs[b] = blocks.count(b) * sizeof(StoredSample);
  }
  Column<StoredSample> column(job.file("sample"));
  job.arena.for_each_within_budget(needs, job.memory.global, [&](std::size_t b) {
    std::vector<StoredSample> samples = blocks.read(b);
    std::sort(samples.begin(), samples.end(),
              [](const StoredSample& x, const StoredSample& y) { return x.point.id < y.point.id; });
    column.write(first_rows[b], samples);
  });
  return column;
}

}  // namespace lacuna
