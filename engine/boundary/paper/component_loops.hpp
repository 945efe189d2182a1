// SPDX-License-Identifier: Apache-2.0
// Finds the loops of one component of the boundary graph. The component is spanned with the edges that all
// tiles have passed on.
#pragma once

#include "engine/boundary/paper/loops.hpp"
#include "engine/boundary/paper/raw_loops.hpp"
#include "engine/boundary/paper/spanning.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/stitch/stitch.hpp"
#include "engine/store/scratch.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna::paper {

// row_of(v): the row of a vertex of the graph.
template <class RowOf>
void find_loops_of(const SpanningGraph& graph, RowOf&& row_of, Scratch& scratch, RawLoops& loops) {
  std::vector<Vertex> loop;
  find_loops(graph, scratch, [&](std::span<const LocalIndex> found) {
    loop.clear();
    for (const LocalIndex v : found) loop.push_back({graph.ids[v], row_of(v)});
    loops.add(loop);
  });
}

// `edge_count`: edges of the whole component, in any order. `e`: an edge may close a loop of more than e
// edges. `memory`: bytes. Arrays beyond it are mapped from files.
void find_component_loops(const Stitch<BoundaryEdge>::ForEachRecord& for_each_edge, std::uint64_t edge_count,
                          std::int64_t e, std::uint64_t memory, const Spill& spill, RawLoops& loops);

}  // namespace lacuna::paper
