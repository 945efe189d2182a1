// SPDX-License-Identifier: Apache-2.0
// The curves between the sampled nodes of one patch and its other nodes.
#pragma once

#include "bench/synth/boundary_curves.hpp"

#include <vector>

namespace lacuna::synth {

// Every curve is closed, because nothing outside of the patch is sampled.
std::vector<Curve> patch_curves(const Lattice& lattice, const Visibility& visibility);

}  // namespace lacuna::synth
