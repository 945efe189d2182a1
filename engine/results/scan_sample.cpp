// SPDX-License-Identifier: Apache-2.0
#include "engine/results/scan_sample.hpp"

#include "engine/model/mixed.hpp"
#include "engine/store/column.hpp"
#include "engine/store/sorted_runs.hpp"

#include <bit>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

constexpr double kBoundaryWeight = 3;  // added to a weight of 1 at the probability 1

// Returns a number that is uniform in (0, 1).
double drawn_from(PointId id) {
  return (static_cast<double>(mixed(value(id)) >> 11) + 0.5) * 0x1p-53;
}

double key_of(PointId id, const Evaluation& e) {
  const double weight = e.mean_distance * e.mean_distance * (1 + kBoundaryWeight * e.probability);
  const double key = drawn_from(id) / weight;
  return key < std::numeric_limits<double>::max() ? key : std::numeric_limits<double>::max();
}

struct ById {
  bool operator()(const SampledPoint& a, const SampledPoint& b) const { return a.id < b.id; }
};

// Each power of two has sixteen bins: positive numbers have the order of their bits.
std::uint32_t bin_of(double key) {
  return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(key) >> 48);
}

}  // namespace

// In ascending bin.
std::vector<ScanSample::BinCount> ScanSample::count_bins(std::span<const double> keys) {
  std::vector<std::uint32_t> points;  // of each bin
  for (const double key : keys) {
    const std::uint32_t bin = bin_of(key);
    if (bin >= points.size()) points.resize(bin + 1);
    ++points[bin];
  }
  std::vector<BinCount> bins;
  for (std::uint32_t bin = 0; bin < points.size(); ++bin) {
    if (points[bin] > 0) bins.push_back({bin, points[bin]});
  }
  return bins;
}

void ScanSample::KeyBins::add(std::span<const BinCount> bins, std::uint64_t most_points) {
  for (const auto& [bin, points] : bins) {
    if (bin > last) break;
    counts[bin] += points;
    keys += points;
  }
  // A bin is removed where the bins before it are enough.
  while (!counts.empty() && keys - counts.rbegin()->second >= most_points) {
    keys -= counts.rbegin()->second;
    counts.erase(std::prev(counts.end()));
  }
  if (keys >= most_points) last = counts.rbegin()->first;
}

void ScanSample::emit(const EvaluatedTile& tile, TileOutput& output) {
  std::vector<double> keys(tile.points.owned);
  for (LocalIndex p = 0; p < tile.points.owned; ++p)
    keys[p] = key_of(tile.points.ids[p], tile.evaluations[p]);
  std::vector<BinCount> bins = count_bins(keys);
  std::uint32_t last = 0;
  {
    const std::lock_guard lock(mutex_);
    bins_.add(bins, most_points_);
    last = bins_.last;
  }
  std::vector<DrawnPoint> drawn;
  for (LocalIndex p = 0; p < tile.points.owned; ++p) {
    if (bin_of(keys[p]) > last) continue;
    const Eigen::Vector3f normal = tile.evaluations[p].normal.cast<float>();
    drawn.push_back({keys[p], {tile.point(p), tile.probability(p), {normal.x(), normal.y(), normal.z()}}});
  }
  std::erase_if(bins, [&](const BinCount& count) { return count.bin > last; });
  output.add(kDrawnPoints, std::move(drawn));
  output.add(kBinCounts, std::move(bins));
}

ScanSample::KeyBins ScanSample::bins_of(const TileOutputs& outputs, std::size_t tiles) const {
  KeyBins bins;
  for (std::size_t t = 0; t < tiles; ++t)
    bins.add(outputs.read(kBinCounts, static_cast<TileIndex>(t)), most_points_);
  return bins;
}

Column<SampledPoint> ScanSample::draw(const TileOutputs& outputs, std::size_t tiles, const Spill& spill,
                                      const Workers& workers, Phases& phases) {
  Phase phase(phases, "sample", 0);
  const KeyBins bins = bins_of(outputs, tiles);
  const MemoryLedger::Lease sorting = workers.memory.ledger.take(workers.memory.work / 4);
  SortedRuns<SampledPoint, ById> sorted(spill.file("sample-sort"), sorting.bytes() / 2);
  sorted.reserve(bins.keys);
  SortedRuns<DrawnPoint> of_last_bin(spill.file("sample-last"), sorting.bytes() / 2);
  std::uint64_t taken = 0;
  std::mutex mutex;
  workers.arena.for_each(tiles, [&](std::size_t t) {
    const std::vector<DrawnPoint> drawn = outputs.read(kDrawnPoints, static_cast<TileIndex>(t));
    const std::lock_guard lock(mutex);
    for (const DrawnPoint& point : drawn) {
      if (bin_of(point.key) > bins.last) continue;
      if (bin_of(point.key) == bins.last && bins.keys > most_points_) {
        of_last_bin.add(point);
      } else {
        sorted.add(point.point);
        ++taken;
      }
    }
  });
  // Several equal keys are in the sample all together, or not at all.
  double last_key = 0, key_before = 0;  // keys are above 0
  of_last_bin.for_each([&](const DrawnPoint& point) {
    if (point.key != key_before && taken <= most_points_) last_key = key_before;
    key_before = point.key;
    ++taken;
  });
  of_last_bin.for_each([&](const DrawnPoint& point) {
    if (point.key <= last_key) sorted.add(point.point);
  });
  Column<SampledPoint> column(spill.file("sample"));
  ColumnWriter<SampledPoint> writer(column);
  sorted.for_each([&](const SampledPoint& sample) { writer.add(sample); });
  writer.finish();
  return column;
}

}  // namespace lacuna
