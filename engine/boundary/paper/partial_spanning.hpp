// SPDX-License-Identifier: Apache-2.0
// span_partially: what of the spanning graph, and of its loops, a part of the eligible edges decides alone,
// such as those of a tile.
#pragma once

#include "engine/boundary/paper/spanning.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/store/scratch.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna::paper {

// The owned vertices, then the foreign ones at the other ends of their edges.
struct PartVertices {
  std::span<const PointId> ids;
  LocalIndex owned;

  LocalIndex size() const { return static_cast<LocalIndex>(ids.size()); }
  // Two parts have an edge between them; the one that owns the lower id reports it. a: owned.
  bool reports(const WeightedEdge& edge) const { return edge.b < owned || ids[edge.a] < ids[edge.b]; }
};

struct PartialSpanning {
  SpanningGraph complete;  // whose loops are loops of the whole
  // Passed on, in any order: edges that are in the graph for certain, and those that may be.
  std::vector<WeightedEdge> taken, undecided;
  std::span<LocalIndex> links;  // of a UnionFind: vertices that all edges of the part connect
};

// `edges`: all that have an owned end, in any order; a: owned. `span_whole` joins the edges passed on with
// those of other parts. That gives a graph whose loops are those of the whole, without the complete ones.
// Most edges are certainly left out, and are not passed on. Trees, and cycles beyond a bridge, are not passed
// on either: no loop needs them. Without foreign vertices nothing is passed on. The graph lives in `scratch`.
// Cost: that of spanning the part.
PartialSpanning span_partially(const PartVertices& vertices, std::vector<WeightedEdge> edges, std::int64_t e,
                               Scratch& scratch);

}  // namespace lacuna::paper
