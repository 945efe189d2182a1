// SPDX-License-Identifier: Apache-2.0
// span_partially: finds what a tile decides alone of the spanning graph and its loops.
#pragma once

#include "engine/boundary/paper/spanning.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/store/scratch.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna::paper {

// The owned vertices, then the foreign ones at the other ends of their edges.
struct KnownVertices {
  std::span<const PointId> ids;
  LocalIndex owned;

  LocalIndex size() const { return static_cast<LocalIndex>(ids.size()); }
  // Two tiles have an edge between them; the one that owns the lower id reports it. a: owned.
  bool reports(const WeightedEdge& edge) const { return edge.b < owned || ids[edge.a] < ids[edge.b]; }
};

struct PartialSpanning {
  SpanningGraph complete;  // whose loops are loops of the whole
  // Edges that are passed on, in any order. Taken edges are in the graph for certain, undecided edges may be.
  std::vector<WeightedEdge> taken, undecided;
  std::span<LocalIndex> links;  // links of a UnionFind: vertices that all edges of the tile connect
};

// `edges`: all edges that have an owned end, in any order; a: owned. `span_whole` joins the edges that all
// tiles pass on to one graph. The loops of that graph and the complete ones are all loops of the whole. Most
// edges are certainly left out, and are not passed on. Trees, and cycles beyond a bridge, are not passed on
// either: no loop needs them. Without foreign vertices nothing is passed on. The graph lives in `scratch`.
// The cost is the cost of spanning the tile.
PartialSpanning span_partially(const KnownVertices& vertices, std::vector<WeightedEdge> edges, std::int64_t e,
                               Scratch& scratch);

}  // namespace lacuna::paper
