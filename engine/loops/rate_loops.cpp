// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/rate_loops.hpp"

#include "engine/loops/emptiness.hpp"
#include "engine/loops/measure_loop.hpp"

#include <cmath>
#include <numbers>

namespace lacuna {

void rate_loops(const TileStore& points, Loops& loops, Job& job) {
  for_each_loop(loops, job, [&](std::size_t i, std::span<const StoredLoopPoint> loop, Scratch& scratch) {
    const CurveEvidence& curve = loops.evidence(i);
    const LoopShape shape = shape_of(loop, scratch);
    LoopEvidence evidence{.clearness = curve.clearness,
                          .surface = curve.surface,
                          .sampling_gap = curve.sampling_gap,
                          .width = 2 * shape.area / shape.perimeter / curve.spacing,
                          .roundness = std::sqrt(4 * std::numbers::pi * shape.area) / shape.perimeter};
    if (shape.kind == LoopKind::kHole)
      evidence.emptiness = emptiness(points, loop, shape, curve.spacing, scratch);
    loops.rate(i, evidence);
  });
}

}  // namespace lacuna
