// SPDX-License-Identifier: Apache-2.0
// The numbers of a run.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/evaluate/totals.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/parallel.hpp"
#include "engine/thin/level.hpp"
#include "engine/track/level_loops.hpp"

#include <span>

namespace lacuna {

// Returns counts and bounds of the input, not of its representatives, and tiles, threads and memory limit in
// effect.
Summary summarise(const Level& level, const Workers& workers);

// Adds what the evaluation of the first level and the search for loops at all levels have found. `eps`: in
// effect.
void add_findings(const Totals& totals, const FoundLoops& found, std::span<const LevelLoops> levels,
                  double eps, Summary& summary);

}  // namespace lacuna
