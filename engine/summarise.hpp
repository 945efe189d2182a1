// SPDX-License-Identifier: Apache-2.0
// The numbers of a run.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/evaluate/totals.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/parallel.hpp"
#include "engine/thin/level.hpp"
#include "engine/track/track_loops.hpp"

#include <cstdint>
#include <span>

namespace lacuna {

// Returns counts and bounds of the input, not of its representatives, and tiles, threads and memory limit in
// effect.
Summary summarise(const Level& level, const Workers& workers);

// Adds what the evaluation of the first level and the search for loops at all levels have found. `eps`: in
// effect.
void add_findings(const Totals& totals, const FoundLoops& found, std::span<const LevelLoops> levels,
                  double eps, Summary& summary);

// What the points of a scan lie on, by how their number falls from level to level, and by the sampled area.
enum class ScanShape : std::uint8_t {
  kTooFewNeighbours,  // to show a surface
  kLines,             // as of a wire or a single profile
  kSurface,           // one thin surface
  kNoSurface,         // a volume or layers, as after noise
};
ScanShape shape_of(const Summary& summary);

}  // namespace lacuna
