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

// Puts out what the grid needs of a tile.
void emit_probabilities(const EvaluatedTile& tile, TileOutput& output);

// The edge of a voxel is the largest power of two that does not exceed the typical neighbour distance. That
// is the median, over the points, of the mean distance to the neighbours. Outliers hardly change it. It
// doubles until OpenVDB's tree takes no more than 128 MiB and the job's memory for the global stage. The grid
// does not depend on that memory if it is at least 128 MiB. `middle`: a place near the points. Voxels are
// sorted on disk.
ProbabilityGrid probability_voxels(const TileOutputs& outputs, const TileStore& store,
                                   const Eigen::Vector3d& middle, Job& job);

}  // namespace lacuna
