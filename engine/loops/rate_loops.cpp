// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/rate_loops.hpp"

#include "engine/loops/confidence.hpp"
#include "engine/loops/measure_loop.hpp"
#include "engine/loops/prominence.hpp"

namespace lacuna {

void rate_loops(const TileStore& points, Loops& loops, const Spill& spill, const Workers& workers) {
  for_each_loop(loops, spill, workers, [&](std::size_t i, std::span<const LoopPoint> loop, Scratch& scratch) {
    const LoopShape shape = shape_of(loop, scratch);
    LoopEvidence evidence = loops.evidence(i);
    evidence.width = 2 * shape.area / shape.perimeter / evidence.spacing;
    evidence.compactness = evidence.width / static_cast<double>(loop.size());
    evidence.kind = shape.kind;
    if (evidence.kind == LoopKind::kHole && could_be_probable(evidence))
      evidence.prominence = prominence(points, loop, shape, evidence.spacing, scratch);
    loops.set_evidence(i, evidence);
  });
}

}  // namespace lacuna
