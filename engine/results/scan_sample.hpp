// SPDX-License-Identifier: Apache-2.0
// A sample of the scan that a browser or a picture can carry, spread evenly over the surface.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/phase.hpp"
#include "engine/store/column.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>

namespace lacuna {

// Sequential Poisson sampling (Ohlsson, 1998): a point of weight w has the key u / w, with u drawn from its
// id, uniform in (0, 1). The points with the smallest keys are the sample. Where keys are equal at its end,
// it has fewer points than wanted. A weight is the area that the point stands for: the square of its mean
// distance to its neighbours. Near a boundary it is up to four times that, by its probability. The sample
// depends on the points alone, not on tiles or threads.
class ScanSample {
 public:
  explicit ScanSample(std::uint64_t most_points) : most_points_(most_points) {}

  // Emits the points of a tile that may be in the sample. Those behind a sample of the tiles so far cannot
  // be. From any thread.
  void emit(const EvaluatedTile& tile, TileOutput& output);
  // Returns the sample in ascending id, once all tiles are evaluated.
  Column<SampledPoint> draw(const TileOutputs& outputs, std::size_t tiles, const Spill& spill,
                            const Workers& workers, Phases& phases);

 private:
  // A point that may be in the sample.
  struct DrawnPoint {
    double key;
    SampledPoint point;

    friend bool operator<(const DrawnPoint& a, const DrawnPoint& b) { return a.key < b.key; }
  };
  // How many points a tile has drawn whose keys lie in a bin.
  struct BinCount {
    std::uint32_t bin, points;
  };
  static constexpr RecordStream<DrawnPoint> kDrawnPoints{"sample"};
  static constexpr RecordStream<BinCount> kBinCounts{"sample bins"};

  // The smallest keys so far, by bins that have the order of the keys.
  struct KeyBins {
    std::uint32_t last = ~std::uint32_t{0};  // no key of the sample lies in a bin behind it
    std::map<std::uint32_t, std::uint64_t> counts;
    std::uint64_t keys = 0;  // in all bins

    // Adds points. Bins that are then behind the last one go.
    void add(std::span<const BinCount> bins, std::uint64_t most_points);
  };
  static std::vector<BinCount> count_bins(std::span<const double> keys);
  // Returns the bins of all tiles.
  KeyBins bins_of(const TileOutputs& outputs, std::size_t tiles) const;

  const std::uint64_t most_points_;
  std::mutex mutex_;
  KeyBins bins_;  // of the tiles that this process has evaluated
};

}  // namespace lacuna
