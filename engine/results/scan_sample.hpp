// SPDX-License-Identifier: Apache-2.0
// A sample of the scan that a browser or a picture can carry, spread evenly over the surface.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/job.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/store/tile_store.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <mutex>

namespace lacuna {

// A sampled point on disk, as plain data.
struct StoredSample {
  StoredPoint point;
  float probability;
  std::array<float, 3> normal;
};

// Sequential Poisson sampling (Ohlsson, 1998): a point of weight w has the key u / w, with u drawn from its
// id, uniform in (0, 1). The points with the smallest keys are the sample. Where keys are equal at its end,
// it has fewer points than wanted. A weight is the area that the point stands for: the square of its mean
// distance to its neighbours. Near a boundary it is up to four times that, by its probability. The sample
// depends on the points alone, not on tiles or threads.
class ScanSample final : public TileConsumer {
 public:
  // As a tile puts it out, in ascending point.
  struct Candidate {
    double key;
    float probability;
    std::array<float, 3> normal;
    LocalIndex point;
    std::uint32_t padding;
  };

  // `ids`: all ids are below.
  ScanSample(std::uint64_t most_points, std::uint64_t ids, const TileStore& store, const Job& job);

  void emit(const EvaluatedTile& tile, TileOutput& output) const override;
  void absorb(TileIndex tile, const TileOutput& output) override;

  // In ascending id. Once every tile was taken; to be called once.
  Column<StoredSample> finish(Job& job);

 private:
  double last_key(Job& job) const;

  const TileStore& store_;
  const std::uint64_t most_points_, ids_;
  std::mutex mutex_;
  std::uint32_t last_bin_ = ~std::uint32_t{0};  // no key of the sample lies in a bin behind it
  std::map<std::uint32_t, std::uint64_t> bins_;  // of keys: how many there are, up to the last bin
  std::uint64_t binned_ = 0;                     // in all bins
  AppendLists<Candidate> candidates_;            // of each tile: points of the sample, and others
};

}  // namespace lacuna
