// Vertices and edges of the boundary graph.
#pragma once

#include "engine/model/ids.hpp"

#include <cstdint>
#include <tuple>

namespace lacuna {

struct Vertex {
  PointId id;
  Row row;

  friend bool operator==(const Vertex& a, const Vertex& b) { return a.row == b.row; }
};

// An edge of the boundary graph of the paper; a.id < b.id. Edges are taken in ascending order of (weight,
// lower id, higher id).
struct BoundaryEdge {
  double weight;
  Vertex a, b;

  friend bool operator<(const BoundaryEdge& x, const BoundaryEdge& y) {
    return std::tie(x.weight, x.a.id, x.b.id) < std::tie(y.weight, y.a.id, y.b.id);
  }
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
