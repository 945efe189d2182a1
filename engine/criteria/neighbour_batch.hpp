// SPDX-License-Identifier: Apache-2.0
// The neighbourhoods of eight points side by side, from which the criteria of a batch are computed.
#pragma once

#include "engine/model/ids.hpp"
#include "engine/simd/batch.hpp"

#include <cstddef>
#include <cstdint>

namespace lacuna {

// Rank i holds the i-th neighbour of each point. Beyond a point's count its offsets are 0.
struct NeighbourBatch {
  std::size_t ranks = 0;       // the largest count
  Batch<double> counts;        // neighbours of each point, from 1 on
  Batch<double>* x = nullptr;  // offsets q - p, by rank
  Batch<double>* y = nullptr;
  Batch<double>* z = nullptr;
  Batch<double>* squared_distance = nullptr;
  Batch<double>* weight = nullptr;  // working space
  Batch<double> mean_distance;      // r_p
  Batch<double> given_normals[3];   // unit; NaN: to be estimated
};

// The points whose neighbours are gathered. A point may occur more than once.
struct NeighbourLists {
  const double* positions;  // x, y, z of all points
  LocalIndex points[kBatchSize];
  const LocalIndex* neighbours[kBatchSize];
  std::uint32_t counts[kBatchSize];
};

// Sets offsets and distances at each of the batch's ranks, and their mean.
void gather_neighbours(const NeighbourLists& lists, NeighbourBatch& batch);

}  // namespace lacuna
