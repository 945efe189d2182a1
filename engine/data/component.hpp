// Parts of the graph of eligible edges, on their way to the spanning graph and its loops.
#pragma once

#include "engine/data/ids.hpp"

#include <cstdint>
#include <tuple>

namespace lacuna {

struct Vertex {
  PointId id;
  Row row;

  friend bool operator==(const Vertex& a, const Vertex& b) { return a.row == b.row; }
};

// An eligible edge of a component of the graph; a.id < b.id. Edges are taken in ascending order of
// (weight, lower id, higher id).
struct ComponentEdge {
  std::uint64_t component;
  double weight;
  Vertex a, b;

  friend bool operator<(const ComponentEdge& x, const ComponentEdge& y) {
    return std::tie(x.component, x.weight, x.a.id, x.b.id) < std::tie(y.component, y.weight, y.a.id, y.b.id);
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
