// SPDX-License-Identifier: Apache-2.0
// span_whole: builds the spanning graph of the edges that all parts have passed on.
#pragma once

#include "engine/boundary/paper/spanning.hpp"
#include "engine/store/scratch.hpp"

#include <cstdint>
#include <functional>
#include <span>

namespace lacuna::paper {

struct PassedEdge {
  LocalIndex a, b;
  double weight;
  bool is_taken;  // for certain; else undecided
};
// Calls visit(edge) for each edge, in any order, as often as wanted.
using ForEachPassedEdge = std::function<void(const std::function<void(const PassedEdge&)>&)>;

// Taken edges are in the graph. Undecided edges are decided in ascending order of (w_total, lower id, higher
// id), by a search among edges before them. So it is the graph that `Spanning` builds from all edges. `ids`:
// the id of each vertex. Vertices are numbered so that edges of one part lie near each other in memory. The
// graph lives in `scratch`. Cost: linear, and a search for each undecided edge.
SpanningGraph span_whole(std::span<const PointId> ids, const ForEachPassedEdge& for_each_edge, std::int64_t e,
                         std::uint64_t sort_budget, Scratch& scratch);

}  // namespace lacuna::paper
