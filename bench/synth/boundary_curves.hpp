// SPDX-License-Identifier: Apache-2.0
// The curves around the parts of a scene's surface that are sampled.
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

// Within a patch, curves run between sampled nodes and others (marching squares), and cross the edges between
// them where sampling ends. Where two patches touch and both are sampled, the surface goes on. Both curves
// are cut out there. Then the open ends are joined, the nearest first. So a curve may run over several
// patches.
std::vector<Curve> boundary_curves(const std::vector<Lattice>& lattices, const Visibility& visibility);

}  // namespace lacuna::synth
