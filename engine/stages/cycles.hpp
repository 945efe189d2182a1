// cycles: what of a spanning graph can lie on a loop, and what of that is settled where only a part of the
// graph is known.
#pragma once

#include "engine/core/scratch.hpp"
#include "engine/stages/spanning.hpp"

#include <cstdint>
#include <span>

namespace lacuna {

// The graph without bridges and the trees that hang off it: its edges that lie on some cycle, in the same
// order. Cost: linear.
SpanningGraph keep_cycles(const SpanningGraph& graph, Scratch& scratch);

// What of a part of a graph edges elsewhere can have to do with. Seen from the part, everything else is one
// more vertex, `outside`, that all open vertices have an edge to.
struct PartCycles {
  SpanningGraph settled;                      // on cycles, none of which can lead outside
  std::span<const std::uint8_t> leads_out;  // by vertex: on a cycle through outside
};

// `open`: ascending, each once. Only cycles between vertices that lead out, and the paths along them, mean
// anything to the rest of the graph. Cost: linear.
PartCycles split_cycles(const SpanningGraph& graph, std::span<const LocalIndex> open, Scratch& scratch);

}  // namespace lacuna
