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

// An edge of the boundary graph of the paper, as tiles pass it on.
struct BoundaryEdge {
  double weight;
  Vertex a, b;
  std::uint64_t is_taken;  // 1: it is in the spanning graph for certain; 0: not known
};

// An edge between numbered vertices.
struct LocalEdge {
  LocalIndex a, b;
};

struct WeightedEdge {
  LocalIndex a, b;
  double weight;
};

}  // namespace lacuna
