// span_partially: what a part of the graph of eligible edges, such as a tile, can tell of the spanning graph and
// its loops without knowing the rest.
#pragma once

#include "engine/store/scratch.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/boundary/paper/spanning.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// The owned vertices, then the foreign ones at the other ends of their edges.
struct PartVertices {
  std::span<const PointId> ids;
  LocalIndex owned;

  LocalIndex size() const { return static_cast<LocalIndex>(ids.size()); }
  // Two parts know of an edge between them: the one that owns the lower id tells of it. a: owned.
  bool tells(const WeightedEdge& edge) const { return edge.b < owned || ids[edge.a] < ids[edge.b]; }
};

struct PartialSpanning {
  SpanningGraph settled;                // whose loops are loops of the whole
  std::vector<WeightedEdge> passed_on;  // in any order
  std::span<LocalIndex> links;          // of a UnionFind: vertices that all edges of the part connect
};

// `edges`: all that have an owned end, in any order; a: owned. Spanned again with what other parts pass on,
// the edges passed on give a graph whose loops are those of the whole, save the settled ones. Left behind is
// what is known to be left out, as are most edges, and what no loop needs: trees, and cycles beyond a bridge.
// Without foreign vertices nothing is passed on. The graph lives in `scratch`.
// Cost: that of spanning the part.
PartialSpanning span_partially(const PartVertices& vertices, std::vector<WeightedEdge> edges, std::int64_t e,
                        Scratch& scratch);

}  // namespace lacuna
