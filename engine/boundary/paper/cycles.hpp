// SPDX-License-Identifier: Apache-2.0
// cycles: the edges of a spanning graph that can lie on a loop. Where only a part of the graph is known, it
// says which of these are complete.
#pragma once

#include "engine/boundary/paper/spanning.hpp"
#include "engine/store/scratch.hpp"

#include <cstdint>
#include <span>

namespace lacuna::paper {

// The graph without its bridges and the trees that hang off it: the edges that lie on some cycle, in the same
// order. A search for loops gives the same: vertices beyond a bridge stay in one branch and join
// no two. Cost: linear.
SpanningGraph keep_cycles(const SpanningGraph& graph, Scratch& scratch);

// The cycles of a graph that is known in part only. The unknown may lie on either side of its bridges.
struct PartCycles {
  SpanningGraph complete;                   // cycles that the rest of the graph has nothing to do with
  std::span<const std::uint8_t> leads_out;  // by vertex: not cut off from the open ones by a bridge
};

// `open`: vertices that may have more edges than are known here; ascending, each once. Paths between vertices
// that lead out keep to such, and so do all loops through one. Without open vertices all cycles are complete.
// Cost: linear.
PartCycles split_cycles(const SpanningGraph& graph, std::span<const LocalIndex> open, Scratch& scratch);

}  // namespace lacuna::paper
