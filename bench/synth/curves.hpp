// SPDX-License-Identifier: Apache-2.0
// curves: the curves around the parts of a scene's surface that are sampled, and those along which the
// density of points jumps.
//
// Idea: within a patch, curves run between sampled nodes and others, and cross the edges between them where
// sampling ends. Where two patches touch and both are sampled, the surface goes on: both curves are cut out
// there, and their open ends joined.
//
// Source: marching squares (Lorensen and Cline 1987, in the plane). Cost: n for the nodes of the lattices,
// and a search on each patch nearby for a place of a curve.
#pragma once

#include "bench/synth/sampled_surface.hpp"

#include <vector>

namespace lacuna::synth {

struct CurveNode {
  Vec3 position;
  Vec3 normal;     // points to a station that samples the place
  double spacing;  // of the points there, metres
  std::uint32_t shape;
  Cause cause;    // why sampling ends there; kNone in a gap too narrow for a hole
  bool at_end;    // of its patch
  bool long_way;  // from here to the next place, across something without points
};

// A curve is closed.
using Curve = std::vector<CurveNode>;

// Open ends are joined, the nearest first. So a curve may run over several patches.
std::vector<Curve> boundary_curves(const std::vector<Lattice>& lattices, const Visibility& visibility);

// A step lies where one station loses a surface and others go on sampling it with at least twice the spacing.
// A tripod circle has one around it. The pieces are open; where one is closed, its first place is its last,
// too.
std::vector<Curve> density_steps(const std::vector<Lattice>& lattices, const Scanner& scanner,
                                 const Visibility& visibility);

}  // namespace lacuna::synth
