// SPDX-License-Identifier: Apache-2.0
// The largest boundary probability in each voxel of a grid, for probability.vdb.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/job.hpp"
#include "engine/store/column.hpp"
#include "engine/store/tile_store.hpp"

#include <Eigen/Geometry>

namespace lacuna {

struct ProbabilityGrid {
  ProbabilityLattice lattice;
  Column<ProbabilityVoxel> voxels;  // each once
};

// Puts out the probabilities of a tile.
void emit_probabilities(const EvaluatedTile& tile, TileOutput& output);

// The edge of a voxel is the largest power of two that does not exceed the typical distance of neighbours. It
// doubles until OpenVDB's tree takes no more than 128 MiB and seven eighths of the job's working memory. The
// grid does not depend on that memory if it is at least 128 MiB. Points outside of `box`, which are strays,
// are left out. `typical_distance`: the median, over the points, of the mean distance to the neighbours;
// outliers hardly change it. Cost: one pass over the tiles.
ProbabilityGrid probability_voxels(const TileOutputs& outputs, double typical_distance,
                                   const Eigen::AlignedBox3d& box, const TileStore& store, Job& job);

}  // namespace lacuna
