// SPDX-License-Identifier: Apache-2.0
// The largest boundary probability in each voxel of a grid, for probability.vdb.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/job.hpp"
#include "engine/store/column.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <map>
#include <mutex>

namespace lacuna {

struct ProbabilityGrid {
  ProbabilityLattice lattice;
  Column<ProbabilityVoxel> voxels;  // each once
};

class ProbabilityVoxels final : public TileConsumer {
 public:
  ProbabilityVoxels(const TileStore& store, const Job& job)
      : tiling_(store.tiling()), probabilities_(job.file("probabilities")) {}

  void emit(const EvaluatedTile& tile, TileOutput& output) const override;
  void absorb(TileIndex tile, const TileOutput& output) override;

  // Once every tile was taken. The edge of a voxel is the largest power of two that does not exceed the
  // typical neighbour distance. That is the median, over the points, of the mean distance to the neighbours.
  // Outliers hardly change it. It doubles until OpenVDB's tree takes no more than 128 MiB and the job's
  // memory for the global stage. The grid does not depend on that memory if it is at least 128 MiB. Points
  // outside of `box`, which are strays, are left out. Cost: one pass over the tiles.
  ProbabilityGrid finish(const TileStore& store, const Eigen::AlignedBox3d& box, Job& job) const;

 private:
  // An exponent of mean distances to the neighbours, and how many points of a tile have it.
  struct DistanceExponent {
    std::int64_t exponent;
    std::uint64_t points;

    DistanceExponent() = default;
    DistanceExponent(const std::pair<const std::int64_t, std::uint64_t>& count)
        : exponent(count.first), points(count.second) {}
  };
  int typical_exponent() const;

  const Tiling& tiling_;
  Column<float> probabilities_;  // by row
  std::mutex mutex_;
  std::map<std::int64_t, std::uint64_t> exponents_;  // of mean distances: how many points have each
};

}  // namespace lacuna
