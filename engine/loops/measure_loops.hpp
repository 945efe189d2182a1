// SPDX-License-Identifier: Apache-2.0
// measure_loops: measures the values by which a user sorts and filters the found loops.
#pragma once

#include "engine/config/config.hpp"
#include "engine/loops/loops.hpp"
#include "engine/model/loop.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/phase.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lacuna {

// Loops in order of (first id, length, ids).
struct MeasuredLoops {
  ChosenLoops loops;
  std::vector<LoopMeasures> measures;
};

// `tracks`: one for each loop. `mean_edge_length` sets the lattice of LoopMeasures::tiles.
MeasuredLoops measure_loops(ChosenLoops loops, std::span<const LoopTrack> tracks, double mean_edge_length,
                            const Spill& spill, const Workers& workers, Phases& phases);

// Returns the loops that the selection reports. It leaves out min_confidence, which track_loops has applied.
std::vector<std::size_t> select_loops(const std::vector<LoopMeasures>& loops, const SelectionConfig& config);

}  // namespace lacuna
