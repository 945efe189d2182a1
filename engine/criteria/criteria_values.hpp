// SPDX-License-Identifier: Apache-2.0
// The criteria of the points of a batch (paper, 4.2 to 4.6).
#pragma once

#include "engine/criteria/neighbour_batch.hpp"
#include "engine/model/detection.hpp"

namespace lacuna {

struct CriteriaParameters {
  double sigma;                  // over r_p
  double cos_cone;               // as in `TangentPlanes`
  double crease_threshold;       // angle probability from which a crease is looked for
  double shares[kMostCriteria];  // of the criteria, in the order of the table; sum 1
  bool uses_normals_off;         // given ones, more than 45 degrees from the estimated ones
};

struct CriteriaValues {
  Batch<double> criteria[kMostCriteria];  // as many as there are, in the order of the table
  Batch<double> probability;              // Pi: combined, a multiple of 2^-24
  Batch<double> mean_distance;            // r_p
  Batch<double> mean_offset[3];           // mu_p - p
  Batch<double> normal[3];                // NaN: no normal
  Batch<double> is_normal_off;            // 1: the given one, by more than 45 degrees from the estimated one
  Batch<double> surface_share;            // of the boundary and the interior shape (4.4)
  Batch<double> gap_near;                 // ranks of the gap neighbours, nearer first; -1: no gap
  Batch<double> gap_far;
};

void evaluate_criteria(const NeighbourBatch& batch, const CriteriaParameters& parameters,
                       CriteriaValues& values);

}  // namespace lacuna
