// SPDX-License-Identifier: Apache-2.0
// Spans components of the boundary graph, and finds their loops (paper, 5.1 and 5.2).
#pragma once

#include "engine/boundary/paper/raw_loops.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/run/job.hpp"
#include "engine/stitch/stitch.hpp"

#include <cstdint>

namespace lacuna::paper {

// Adds the loops of one or several whole components. `edge_count`: all of their eligible edges, in any order.
// `e`: an edge may close a loop of more than e edges. `memory`: bytes. Arrays beyond it are mapped from
// files. Cost: a sort of the edges, and a search for each edge within a tree.
void find_component_loops(const Stitch<BoundaryEdge>::ForEachRecord& for_each_edge, std::uint64_t edge_count,
                          std::int64_t e, std::uint64_t memory, const Job& job, RawLoops& loops);

}  // namespace lacuna::paper
