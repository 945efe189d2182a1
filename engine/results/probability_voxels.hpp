// The largest boundary probability in each voxel of a grid, for probability.vdb.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/job.hpp"
#include "engine/store/column.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>

namespace lacuna {

struct ProbabilityGrid {
  ProbabilityLattice lattice;
  Column<ProbabilityVoxel> voxels;  // each once
};

class ProbabilityVoxels final : public TileConsumer {
 public:
  explicit ProbabilityVoxels(const Job& job) : probabilities_(job.file("probabilities")) {}

  void take(const EvaluatedTile& tile) override;

  // Once every tile was taken. The edge of a voxel is the largest power of two that is no more than `mean_edge_length`. It
  // doubles until OpenVDB's tree takes no more than 128 MiB and the job's memory for the global stage. The grid does not
  // depend on that memory if it is at least 128 MiB. `middle`: a place near the points. Voxels are sorted on disk.
  ProbabilityGrid finish(const TileStore& store, double mean_edge_length, const Eigen::Vector3d& middle, Job& job) const;

 private:
  Column<float> probabilities_;  // by row
};

}  // namespace lacuna
