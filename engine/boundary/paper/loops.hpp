// SPDX-License-Identifier: Apache-2.0
// loops: closed loops of the spanning graph, by breadth-first search (paper, 5.2).
#pragma once

#include "engine/boundary/paper/spanning.hpp"
#include "engine/store/scratch.hpp"

#include <functional>
#include <span>

namespace lacuna::paper {

// Calls report(loop) for each loop, in the order in which loops are found. The vertices of a loop start at
// its smallest id and go on to the smaller neighbour of that vertex. A search starts from every vertex that
// is not yet on a loop, in ascending id. The first edge that joins two branches of the origin closes the loop
// through it. Differs from the paper: the paper stops at the first vertex that it reaches again, whether or
// not the loop contains the origin. Without a loop nothing is reported. Cost: the vertices within half a loop
// of each origin. A search that finds no loop costs most: `keep_cycles` leaves such origins out beforehand.
void find_loops(const SpanningGraph& graph, Scratch& scratch,
                const std::function<void(std::span<const LocalIndex>)>& report);

}  // namespace lacuna::paper
