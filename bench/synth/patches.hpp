// SPDX-License-Identifier: Apache-2.0
// The surfaces of a scene, cut into rectangular patches.
#pragma once

#include "bench/synth/scene.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace lacuna::synth {

// Places and unit normals are functions of u and v, both in [0, 1]. Patches of one shape share their edges.
struct Patch {
  std::uint32_t shape;   // Hit::shape
  bool two_sided;        // else the normal points out of the shape
  double width, height;  // metres along u and v, about
  std::function<Vec3(double, double)> place;
  std::function<Vec3(double, double)> normal;
};

// Returns the patches of all shapes that return light; black shapes have no patch. Flat patches end a tenth
// of a millimetre before their edges, where two shapes that touch would hide each other.
std::vector<Patch> patches_of(const Scene& scene);

}  // namespace lacuna::synth
