// SPDX-License-Identifier: Apache-2.0
// cycles: finds the edges of a spanning graph that can lie on a loop.
#pragma once

#include "engine/boundary/paper/spanning.hpp"
#include "engine/store/scratch.hpp"

namespace lacuna::paper {

// Returns the graph without its bridges and the trees that hang off it. The edges that lie on some cycle
// remain, in the same order. A search for loops gives the same result: vertices beyond a bridge stay in one
// branch and join no two branches. Cost: linear.
SpanningGraph keep_cycles(const SpanningGraph& graph, Scratch& scratch);

}  // namespace lacuna::paper
