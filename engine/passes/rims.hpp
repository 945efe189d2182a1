// The rims of the agreed triangles, stitched across tiles: loops of the default method.
#pragma once

#include "engine/passes/evaluate.hpp"
#include "engine/passes/trace.hpp"

namespace lacuna {

// Stars at seams once all points have their seats, their triangles agreed on between tiles, and the rims
// followed: whole ones within a tile, parts of others joined at the ends of the edges that cross the seam.
// Rims of fewer than `kLeastRim` points are left out: no ball that is larger than those of triangles rests on
// so few. Consumes stars and gaps.
RawLoops trace_rims(EvaluatedScan& scan, const TileStore& store, Job& job);

inline constexpr std::size_t kLeastRim = 8;

}  // namespace lacuna
