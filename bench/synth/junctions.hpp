// SPDX-License-Identifier: Apache-2.0
// Finds where the patches of a scene touch.
#pragma once

#include "bench/synth/boundary_curves.hpp"

#include <cstddef>
#include <vector>

namespace lacuna::synth {

class Junctions {
 public:
  Junctions(const std::vector<Lattice>& lattices, const Visibility& visibility);

  // Whether another patch passes through this place of a curve, and is sampled there. It can only at the end
  // of a patch, at the foot of a thing, around an opening, and in a gap that was closed.
  bool surface_goes_on(const CurveNode& place, std::size_t patch) const;

 private:
  struct Bounds {
    Vec3 low, high;
  };

  const std::vector<Lattice>& lattices_;
  const Visibility& visibility_;
  std::vector<Bounds> bounds_;  // of the patches
};

}  // namespace lacuna::synth
