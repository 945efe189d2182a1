// SPDX-License-Identifier: Apache-2.0
// rate_loops: collects the evidence of each loop that its level has (method.md, D.3). Of holes, that is also
// how far they stand out of the gaps of the sampling around them. Of outer curves, it is what lies over them
// and beyond.
//
// Idea: the plane of the loop is a raster. A pixel is sampled where a point lies over it, near the height of
// the loop. The distances from all pixels to sampled ones say how empty the hole is, and how empty its
// surroundings are. Where points lie beyond an outer curve, at its height, the surface does not end. All
// decisions are counts of pixels and points, so the order in which points arrive changes nothing.
//
// Source: method.md, D.3; distances: Felzenszwalb, Huttenlocher, Distance Transforms of Sampled Functions,
// 2012. Cost: linear in the points of loops, and `prominence` or `beyond_curve` of the loops that may be
// probable.
#pragma once

#include "engine/loops/loops.hpp"
#include "engine/loops/measure_loops.hpp"
#include "engine/run/parallel.hpp"
#include "engine/store/scratch.hpp"
#include "engine/store/tile_store.hpp"

#include <span>

namespace lacuna {

// Returns the largest distance from a place within the hole to a point, over the gap of the sampling around
// it. Nine in ten places around the hole are nearer to a point than the gap. Distances are those in the plane
// of the loop, on a raster. The result is 1 for a gap like those around it, and 0 for a loop that encloses
// nothing. `points`: of the level; `spacing`: along the loop. Cost: the points in the box of the hole and its
// surroundings, and at most 65,536 pixels.
double prominence(const TileStore& points, std::span<const LoopPoint> loop, const LoopShape& shape,
                  double spacing, Scratch& scratch);

// Returns what lies over an outer curve and beyond it. `radius`: of its farthest point from the centroid.
// Cost: the points in the box of the curve, as high as the radius, and twice those near the curve.
BeyondCurve beyond_curve(const TileStore& points, std::span<const LoopPoint> loop, const LoopShape& shape,
                         double radius, double spacing, Scratch& scratch);

// Adds the evidence that the curves do not have, but not the track, which tracking finds. `points`: of
// the level.
void rate_loops(const TileStore& points, Loops& loops, const Spill& spill, const Workers& workers);

}  // namespace lacuna
