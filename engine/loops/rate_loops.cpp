// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/rate_loops.hpp"

#include "engine/loops/emptiness.hpp"
#include "engine/loops/measure_loop.hpp"

#include <cmath>
#include <numbers>

namespace lacuna {

void rate_loops(const TileStore& points, Loops& loops, Job& job) {
  for_each_loop(loops, job, [&](std::size_t i, std::span<const LoopPoint> loop, Scratch& scratch) {
    const LoopShape shape = shape_of(loop, scratch);
    LoopEvidence evidence = loops.evidence(i);
    evidence.width = 2 * shape.area / shape.perimeter / evidence.spacing;
    evidence.roundness = std::sqrt(4 * std::numbers::pi * shape.area) / shape.perimeter;
    if (shape.kind == LoopKind::kHole)
      evidence.emptiness = emptiness(points, loop, shape, evidence.spacing, scratch);
    loops.set_evidence(i, evidence);
  });
}

}  // namespace lacuna
