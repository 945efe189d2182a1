// SPDX-License-Identifier: Apache-2.0
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

constexpr std::uint64_t kBlock = 1 << 16;  // ids of a block of the sample, which is ordered in memory
constexpr double kBoundaryWeight = 3;      // added to a weight of 1 at the probability 1

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

// In ascending id. All ids are in one block.
void order(std::vector<StoredSample>& samples) {
  std::vector<LocalIndex> places(kBlock, kNoIndex);
  for (LocalIndex i = 0; i < samples.size(); ++i) places[value(samples[i].point.id) % kBlock] = i;
  std::vector<StoredSample> ordered;
  ordered.reserve(samples.size());
  for (const LocalIndex place : places) {
    if (place != kNoIndex) ordered.push_back(samples[place]);
  }
  samples.swap(ordered);
}

}  // namespace

ScanSample::ScanSample(std::uint64_t most_points, std::uint64_t ids, const TileStore& store, const Job& job)
    : store_(store),
      most_points_(most_points),
      ids_(ids),
      candidates_(job.file("sample-keys"), store.tiling().tiles.size(), job.memory.spills / 8) {}

// Keys of all points: an update may keep this output, and draw its sample from fewer points.
void ScanSample::emit(const EvaluatedTile& tile, TileOutput& output) const {
  std::vector<Candidate> samples;
  samples.reserve(tile.points.owned);
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    const Evaluation& e = tile.evaluations[p];
    const Eigen::Vector3f normal = e.normal.cast<float>();
    samples.push_back(
        {key_of(tile.points.ids[p], e), tile.probability(p), {normal.x(), normal.y(), normal.z()}, p, 0});
  }
  output.add("sample", std::move(samples));
}

void ScanSample::absorb(TileIndex tile, const TileOutput& output) {
  const std::span<const Candidate> emitted = output.read<Candidate>("sample");
  std::vector<Candidate> candidates(emitted.begin(), emitted.end());
  const std::lock_guard lock(mutex_);
  std::erase_if(candidates, [&](const Candidate& candidate) { return bin_of(candidate.key) > last_bin_; });
  candidates_.append(tile, candidates);
  for (const Candidate& candidate : candidates) ++bins_[bin_of(candidate.key)];
  binned_ += candidates.size();
  // A bin goes where those before it are enough.
  while (!bins_.empty() && binned_ - bins_.rbegin()->second >= most_points_) {
    binned_ -= bins_.rbegin()->second;
    bins_.erase(std::prev(bins_.end()));
  }
  if (binned_ >= most_points_) last_bin_ = bins_.rbegin()->first;
}

// The largest key of the sample. Only those of the last bin are to be ordered.
double ScanSample::last_key(Job& job) const {
  if (binned_ <= most_points_) return std::numeric_limits<double>::max();
  SortedRuns<double> of_last_bin(job.file("sample-last"), job.memory.spills / 8);
  for (std::size_t t = 0; t < candidates_.lists(); ++t) {
    candidates_.for_each(t, [&](const Candidate& candidate) {
      if (bin_of(candidate.key) == last_bin_) of_last_bin.add(candidate.key);
    });
  }
  // All of several equal keys are in the sample, or none.
  const double first_of_bin = std::bit_cast<double>(std::uint64_t{last_bin_} << 48);
  double last = std::nextafter(first_of_bin, -1), key_before = last;
  std::uint64_t taken = binned_ - of_last_bin.size();  // all of the bins before
  of_last_bin.for_each([&](double key) {
    if (key != key_before && taken <= most_points_) last = key_before;
    key_before = key;
    ++taken;
  });
  return last;
}

Column<StoredSample> ScanSample::finish(Job& job) {
  Phase phase(job, "sample", 0);
  AppendLists<StoredSample> blocks(job.file("sample-blocks"), ids_ / kBlock + 1, job.memory.spills / 8);
  const double last = last_key(job);
  job.arena.for_each(candidates_.lists(), [&](std::size_t t) {
    Outbox<StoredSample> outbox(blocks);
    std::vector<Candidate> sampled = candidates_.read(t);
    std::erase_if(sampled, [&](const Candidate& candidate) { return candidate.key > last; });
    auto next = sampled.begin();
    LocalIndex point = 0;
    store_.for_each_point(static_cast<TileIndex>(t), [&](const StoredPoint& p) {
      if (next == sampled.end() || next->point != point++) return;
      outbox.add(static_cast<TileIndex>(value(p.id) / kBlock), {p, next->probability, next->normal});
      ++next;
    });
    outbox.send();
  });
  std::vector<std::uint64_t> first_rows(blocks.lists()), needs(blocks.lists());
  std::uint64_t row = 0;
  for (std::size_t b = 0; b < blocks.lists(); ++b) {
    first_rows[b] = row;
    row += blocks.count(b);
    needs[b] = 2 * blocks.count(b) * sizeof(StoredSample) + kBlock * sizeof(LocalIndex);
  }
  Column<StoredSample> column(job.file("sample"));
  job.arena.for_each_within_budget(needs, job.memory.global, [&](std::size_t b) {
    std::vector<StoredSample> samples = blocks.read(b);
    order(samples);
    column.write(first_rows[b], samples);
  });
  return column;
}

}  // namespace lacuna
