// SPDX-License-Identifier: Apache-2.0
// The curves between the sampled nodes of one patch and its others.
#pragma once

#include "bench/synth/boundary_curves.hpp"

#include <vector>

namespace lacuna::synth {

// Every curve is closed: outside of the patch nothing is sampled.
std::vector<Curve> patch_curves(const Lattice& lattice, const Visibility& visibility);

}  // namespace lacuna::synth
