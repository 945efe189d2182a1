// SPDX-License-Identifier: Apache-2.0
// Computes how large a loop is and where it lies, for people who compare results with the truth.
#pragma once

#include "io/explain/matching/match_loops.hpp"

#include <span>

#include <Eigen/Core>

namespace lacuna::evaluation {
using namespace matching;

// In units of the scan.
struct LoopSize {
  double perimeter = 0;             // sum of the edges' lengths
  double diameter = 0;              // largest distance between two vertices
  double area = 0;                  // projected along its normal; of an open loop: closed over its centre
  Eigen::Vector3d centre{0, 0, 0};  // mean of the vertices
};

// Ids are places in `positions`, which are finite there. A loop without edges has a size of 0.
LoopSize size_of(const TrueLoop& loop, std::span<const Eigen::Vector3d> positions);
LoopSize size_of(const LoopIds& loop, std::span<const Eigen::Vector3d> positions);

}  // namespace lacuna::evaluation
