// SPDX-License-Identifier: Apache-2.0
// The values that decide the orientation of normals.
#pragma once

#include "engine/model/ids.hpp"

#include <cstdint>

namespace lacuna {

// An edge of G for the orientation of normals.
struct OrientationEdge {
  double weight;  // 1 - |n_a . n_b|
  PointId low_id, high_id;
  Row low, high;
  std::uint64_t opposed;  // the normals point to different sides

  friend bool operator<(const OrientationEdge& x, const OrientationEdge& y) {
    if (x.weight != y.weight) return x.weight < y.weight;
    return x.low_id != y.low_id ? x.low_id < y.low_id : x.high_id < y.high_id;
  }
};

}  // namespace lacuna
