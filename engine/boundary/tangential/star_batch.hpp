// SPDX-License-Identifier: Apache-2.0
// The stars of a batch of points (stars.hpp), one in each lane.
#pragma once

#include "engine/boundary/tangential/star.hpp"
#include "engine/simd/batch.hpp"

#include <cstddef>
#include <cstdint>

namespace lacuna::tangential {

inline constexpr std::size_t kMostNeighbours = 64;  // of one point

struct StarBatch {
  const Site* sites;  // of all points
  LocalIndex points[kBatchSize];
  const LocalIndex* neighbours[kBatchSize];  // where there are none: of any one point
  std::uint32_t counts[kBatchSize];          // of neighbours; 0: no star
  double normals[3][kBatchSize];             // unit; NaN: no star
};

struct BatchStars {
  static constexpr std::uint32_t kAmbiguous = UINT32_MAX;

  LinkVertex<LocalIndex> links[kMostNeighbours][kBatchSize];  // by their numbers among the neighbours
  std::uint32_t sizes[kBatchSize];  // ambiguous: vertices are so near to a line that rounding decides
  double distances[kBatchSize];     // `Sampling::distance`
};

void find_batch_stars(const StarBatch& batch, BatchStars& stars);

}  // namespace lacuna::tangential
