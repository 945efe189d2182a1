// SPDX-License-Identifier: Apache-2.0
// cycles: finds the edges of a spanning graph that can lie on a loop. Where only a part of the graph is
// known, it finds which cycles are complete.
#pragma once

#include "engine/boundary/paper/spanning.hpp"
#include "engine/store/scratch.hpp"

#include <cstdint>
#include <span>

namespace lacuna::paper {

// Returns the graph without its bridges and the trees that hang off it. The edges that lie on some cycle
// remain, in the same order. A search for loops gives the same result: vertices beyond a bridge stay in one
// branch and join no two branches. Cost: linear.
SpanningGraph keep_cycles(const SpanningGraph& graph, Scratch& scratch);

// The cycles of a graph of which only a part is known. The unknown part may lie on either side of its
// bridges.
struct PartCycles {
  SpanningGraph complete;                   // cycles that do not touch the rest of the graph
  std::span<const std::uint8_t> leads_out;  // by vertex: no bridge cuts it off from the open ones
};

// `open`: vertices that may have more edges than are known here; ascending, each once. A path between
// vertices that lead out passes only such vertices. So does every loop through one of them. Without open
// vertices all cycles are complete. Cost: linear.
PartCycles split_cycles(const SpanningGraph& graph, std::span<const LocalIndex> open, Scratch& scratch);

}  // namespace lacuna::paper
