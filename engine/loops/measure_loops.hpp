// SPDX-License-Identifier: Apache-2.0
// measure_loops: what a user sorts and filters the found loops by.
#pragma once

#include "engine/config/config.hpp"
#include "engine/loops/placed_loops.hpp"
#include "engine/model/loop.hpp"
#include "engine/run/job.hpp"

#include <cstddef>
#include <vector>

namespace lacuna {

// In order of (first id, length, ids).
struct MeasuredLoops {
  PlacedLoops loops;
  std::vector<LoopMeasures> measures;
};

// `mean_edge_length` sets the lattice of LoopMeasures::tiles.
MeasuredLoops measure_loops(TrackedLoops tracked, double mean_edge_length, Job& job);

// The loops that the selection reports.
std::vector<std::size_t> select_loops(const std::vector<LoopMeasures>& loops, const SelectionConfig& config);

}  // namespace lacuna
