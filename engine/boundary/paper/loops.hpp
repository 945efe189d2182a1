// SPDX-License-Identifier: Apache-2.0
// loops: closed loops of the spanning graph, by breadth-first search (paper, 5.2).
#pragma once

#include "engine/boundary/paper/spanning.hpp"
#include "engine/store/scratch.hpp"

#include <functional>
#include <span>

namespace lacuna::paper {

// report(loop) for each loop, its vertices in order from the smallest id towards that one's smaller
// neighbour, in the order in which they are found. A search starts from every vertex that is not yet on a
// loop, in ascending id. The first edge that joins two branches of the origin closes the loop through it.
// Differs from the paper: which stops at the first vertex that it reaches again, whether or not the loop
// contains the origin. No loop: no report. Cost: the vertices within half a loop of each origin. A search
// that finds no loop costs most: `keep_cycles` leaves such origins out beforehand.
void find_loops(const SpanningGraph& graph, Scratch& scratch,
                const std::function<void(std::span<const LocalIndex>)>& report);

}  // namespace lacuna::paper
