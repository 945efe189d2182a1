// Coherence over all tiles (paper, 5.1).
#pragma once

#include "engine/passes/evaluate.hpp"
#include "engine/passes/raw_loops.hpp"

namespace lacuna {

// The greatest set of candidates of which each has both of its gap neighbours in it. Tiles are settled on
// their own and looked at again while a tile that they lean on changes; the result does not depend on the
// order. Memory: one bit per row.
RowSet make_coherent(const EvaluatedScan& scan, const TileStore& store, Job& job);

// The same asked of rims: candidates whose gap neighbours both lie on loops, of those that are as sure as the
// selection wants them. They stand on the rim between the points on which a ball rests.
RowSet find_beside_loops(const RawLoops& loops, const EvaluatedScan& scan, const TileStore& store, Job& job);

}  // namespace lacuna
