// SPDX-License-Identifier: Apache-2.0
// Vertices and edges of the boundary graph.
#pragma once

#include "engine/model/ids.hpp"

#include <cstdint>

namespace lacuna {

struct Vertex {
  PointId id;
  Row row;

  friend bool operator==(const Vertex& a, const Vertex& b) { return a.row == b.row; }
};

// An eligible edge of the paper.
struct BoundaryEdge {
  double weight;
  Vertex a, b;
};

}  // namespace lacuna
