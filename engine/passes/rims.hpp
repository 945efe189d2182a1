// The rims of the agreed triangles, stitched across tiles: loops of the default method.
#pragma once

#include "engine/passes/evaluate.hpp"
#include "engine/passes/raw_loops.hpp"

namespace lacuna {

// The stars at seams settled, then the rims followed: whole ones within a tile, parts of others joined at the
// ends of the edges that cross a seam. Those of fewer than `min_curve` points are left out: around so few, a
// sampling leaves gaps by itself. Consumes the lists.
RawLoops trace_rims(StarLists& lists, const Tiling& tiling, Job& job);

}  // namespace lacuna
