// SPDX-License-Identifier: Apache-2.0
// The combined criteria of one point.
#pragma once

#include "engine/model/ids.hpp"

#include <limits>

#include <Eigen/Core>

namespace lacuna {

struct Evaluation {
  double probability = 1;    // Pi: combined, a multiple of 2^-24
  double mean_distance = 0;  // r_p
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d mean_offset{0, 0, 0};  // mu_p - p
  LocalIndex gap_near = kNoIndex;        // gap neighbours, nearer first; kNoIndex: no gap
  LocalIndex gap_far = kNoIndex;
  float surface_share = 0;     // how much the neighbourhood resembles a surface (paper, 4.4), [0, 1]
  bool is_normal_off = false;  // the given normal, by more than 45 degrees from the estimated one
};

}  // namespace lacuna
