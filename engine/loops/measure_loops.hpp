// SPDX-License-Identifier: Apache-2.0
// measure_loops: measures the values by which a user sorts and filters the found loops.
#pragma once

#include "engine/config/config.hpp"
#include "engine/loops/loops.hpp"
#include "engine/model/loop.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/phase.hpp"
#include "engine/store/scratch.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lacuna {

// A loop is a hole or an outer boundary. To decide, its points are moved towards the surface (by the mean of
// their neighbours). If the area that the loop encloses grows, the surface lies outside: a hole. If the area
// shrinks, the surface lies inside: an outer boundary. A cap of less than about half a sphere has an outer
// boundary, a larger one a hole.
//
// `normal` is the direction of the polygon's area vector (Newell), turned so that its largest component is
// positive. `area` is the length of this vector: the area of the loop projected along the normal.
// `planarity` is 1 - sqrt(smallest / largest eigenvalue of the points' covariance). `tiles` counts cubes of a
// fixed lattice, of edge `lattice_edge`, that hold a point of the loop. So the number does not depend on the
// tiling of the run. `scratch` holds the loop and the arrays for its measures. Precondition: three points or
// more. Cost: linear, except for the diameter (see `diameter`).
LoopMeasures measure_loop(std::span<const LoopPoint> loop, double lattice_edge, Scratch& scratch);

// As in `LoopMeasures`. Cost: linear.
struct LoopShape {
  LoopKind kind;
  double perimeter, area;
  Eigen::Vector3d centroid, normal;
};
LoopShape shape_of(std::span<const LoopPoint> loop, Scratch& scratch);

// Calls visit(before, at, after) for each point of the loop, in order.
template <class Visit>
void for_each_with_neighbours(std::span<const LoopPoint> loop, Scratch& scratch, Visit&& visit) {
  const std::size_t n = loop.size();
  std::size_t i = 0;
  scratch.for_each(loop, [&](const LoopPoint& at) {
    visit(loop[(i + n - 1) % n], at, loop[(i + 1) % n]);
    ++i;
  });
}

// Returns the largest distance between two points, exactly, by branch and bound over runs of the loop.
double diameter(std::span<const LoopPoint> loop, Scratch& scratch);

// These functions take a loop in memory, in any order (`order_by_place`).
LoopMeasures measure_loop(const Loop& loop, double lattice_edge);
double diameter(const Loop& loop);

// Loops in order of (first id, length, ids).
struct MeasuredLoops {
  ChosenLoops loops;
  std::vector<LoopMeasures> measures;
};

// `tracks`: one for each loop. `mean_edge_length` sets the lattice of LoopMeasures::tiles.
MeasuredLoops measure_loops(ChosenLoops loops, std::span<const LoopTrack> tracks, double mean_edge_length,
                            const Spill& spill, const Workers& workers, Phases& phases);

// Returns the loops that the selection reports. It leaves out min_confidence, which track_loops has applied.
std::vector<std::size_t> select_loops(const std::vector<LoopMeasures>& loops, const SelectionConfig& config);

}  // namespace lacuna
