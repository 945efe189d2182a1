// SPDX-License-Identifier: Apache-2.0
// measure_loop: what a user sorts and filters loops by.
#pragma once

#include "engine/loops/loops.hpp"
#include "engine/model/loop.hpp"
#include "engine/store/scratch.hpp"

#include <span>

namespace lacuna {

// Hole or outer boundary: the loop's points are moved towards the surface (by the mean of their neighbours).
// If the area that the loop encloses grows, the surface lies outside: a hole. If it shrinks, inside: an outer
// boundary. A cap of less than about half a sphere has an outer boundary, a larger one a hole.
//
// `normal` is that of the polygon's area vector (Newell), by the right hand rule about the written direction.
// `area` is its length, that of the loop seen along the normal. `planarity` is 1 - sqrt(smallest / largest
// eigenvalue of the points' covariance). `tiles` counts cubes of a fixed lattice, of edge `lattice_edge`,
// that hold a point of the loop. So the number does not depend on the tiling of the run. `scratch` holds the
// loop and what measuring it needs. Precondition: three points or more. Cost: linear, but for the diameter
// (see `diameter`).
LoopMeasures measure_loop(std::span<const StoredLoopPoint> loop, double lattice_edge, Scratch& scratch);

// As in `LoopMeasures`. Cost: linear.
struct LoopShape {
  double perimeter, area;
};
LoopShape shape_of(std::span<const StoredLoopPoint> loop, Scratch& scratch);

// Largest distance between two points, exactly, by branch and bound over runs of the loop.
double diameter(std::span<const StoredLoopPoint> loop, Scratch& scratch);

// These take a loop in memory.
LoopMeasures measure_loop(const Loop& loop, double lattice_edge);
double diameter(const Loop& loop);

}  // namespace lacuna
