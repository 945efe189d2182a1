// SPDX-License-Identifier: Apache-2.0
#include "engine/results/scan_sample.hpp"

#include "engine/store/column_writer.hpp"
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

// Returns a number that is uniform in (0, 1), by the mixer of SplitMix64 (Steele, Lea, Flood, 2014).
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

// Each power of two has sixteen bins: positive numbers have the order of their bits.
std::uint32_t bin_of(double key) {
  return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(key) >> 48);
}

}  // namespace

void ScanSample::KeyBins::take(std::vector<DrawnPoint>& points, std::uint64_t most_points) {
  std::erase_if(points, [&](const DrawnPoint& point) { return bin_of(point.key) > last; });
  for (const DrawnPoint& point : points) ++counts[bin_of(point.key)];
  keys += points.size();
  // A bin is removed where the bins before it are enough.
  while (!counts.empty() && keys - counts.rbegin()->second >= most_points) {
    keys -= counts.rbegin()->second;
    counts.erase(std::prev(counts.end()));
  }
  if (keys >= most_points) last = counts.rbegin()->first;
}

void ScanSample::emit(const EvaluatedTile& tile, TileOutput& output) {
  std::vector<DrawnPoint> points;
  points.reserve(tile.points.owned);
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    const Evaluation& e = tile.evaluations[p];
    const Eigen::Vector3f normal = e.normal.cast<float>();
    points.push_back(
        {key_of(tile.points.ids[p], e), tile.probability(p), {normal.x(), normal.y(), normal.z()}, p, 0});
  }
  {
    const std::lock_guard lock(mutex_);
    bins_.take(points, most_points_);
  }
  output.add(kDrawnPoints, std::move(points));
}

// Returns the largest key of the sample. Only the keys of the last bin have to be ordered.
double ScanSample::last_key(const TileOutputs& outputs, std::size_t tiles, Job& job) const {
  KeyBins bins;  // other processes may have evaluated tiles, too
  for (std::size_t t = 0; t < tiles; ++t) {
    std::vector<DrawnPoint> points = outputs.read(kDrawnPoints, static_cast<TileIndex>(t));
    bins.take(points, most_points_);
  }
  // Outputs of tiles that were evaluated early have keys of later bins, too.
  const auto first_of = [](std::uint32_t bin) { return std::bit_cast<double>(std::uint64_t{bin} << 48); };
  if (bins.keys <= most_points_) {
    const bool has_all = bins.last == KeyBins().last;
    return has_all ? std::numeric_limits<double>::max() : std::nextafter(first_of(bins.last + 1), -1);
  }
  const MemoryLedger::Lease sorting = job.ledger.take(job.memory.work / 8);
  SortedRuns<double> of_last_bin(job.file("sample-last"), sorting.bytes());
  for (std::size_t t = 0; t < tiles; ++t) {
    for (const DrawnPoint& point : outputs.read(kDrawnPoints, static_cast<TileIndex>(t))) {
      if (bin_of(point.key) == bins.last) of_last_bin.add(point.key);
    }
  }
  // Several equal keys are in the sample all together, or not at all.
  double last = std::nextafter(first_of(bins.last), -1), key_before = last;
  std::uint64_t taken = bins.keys - of_last_bin.size();  // all of the bins before
  of_last_bin.for_each([&](double key) {
    if (key != key_before && taken <= most_points_) last = key_before;
    key_before = key;
    ++taken;
  });
  return last;
}

Column<StoredSample> ScanSample::draw(const TileOutputs& outputs, const TileStore& store, Job& job) {
  Phase phase(job, "sample", 0);
  const std::size_t tiles = store.tiling().tiles.size();
  const double last = last_key(outputs, tiles, job);
  const MemoryLedger::Lease sorting = job.ledger.take(job.memory.work / 4);
  SortedRuns<StoredSample> sorted(job.file("sample-sort"), sorting.bytes());
  std::mutex mutex;
  job.arena.for_each(tiles, [&](std::size_t i) {
    const auto t = static_cast<TileIndex>(i);
    std::vector<DrawnPoint> sampled = outputs.read(kDrawnPoints, t);
    std::erase_if(sampled, [&](const DrawnPoint& point) { return point.key > last; });
    std::vector<StoredSample> samples;
    auto next = sampled.begin();
    LocalIndex owned = 0;
    store.for_each_point(t, [&](const StoredPoint& p) {
      if (next == sampled.end() || next->owned != owned++) return;
      samples.push_back({p, next->probability, next->normal});
      ++next;
    });
    const std::lock_guard lock(mutex);
    sorted.add(samples);
  });
  Column<StoredSample> column(job.file("sample"));
  ColumnWriter<StoredSample> writer(column);
  sorted.for_each([&](const StoredSample& sample) { writer.add(sample); });
  writer.finish();
  return column;
}

}  // namespace lacuna
