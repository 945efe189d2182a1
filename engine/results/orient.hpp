// SPDX-License-Identifier: Apache-2.0
// orient: orients normals consistently by a minimum spanning tree of G (Hoppe et al. 1992).
#pragma once

#include "engine/model/ids.hpp"

#include <cstdint>
#include <vector>

#include <Eigen/Core>

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

struct OrientedEnd {
  PointId id;
  Row row;
  Eigen::Vector3d normal;
};

// Returns the edge of G between two points: weight 1 - |n_a . n_b|, ties by ids.
OrientationEdge orientation_edge(const OrientedEnd& a, const OrientedEnd& b);

// Returns the edges of the minimum spanning forest of a graph over rows [first_row, first_row + rows).
std::vector<OrientationEdge> spanning_forest(std::vector<OrientationEdge> edges, std::uint64_t first_row,
                                             LocalIndex rows);

}  // namespace lacuna
