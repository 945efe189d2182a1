// SPDX-License-Identifier: Apache-2.0
// The curves along which the density of points jumps, with surface on both sides.
#pragma once

#include "bench/synth/boundary_curves.hpp"

#include <vector>

namespace lacuna::synth {

// A step lies where one station loses a surface and others go on sampling it with at least twice the spacing.
// A tripod circle has one around it. The pieces are open; where one is closed, its first place is its last,
// too.
std::vector<Curve> density_steps(const std::vector<Lattice>& lattices, const Scanner& scanner,
                                 const Visibility& visibility);

}  // namespace lacuna::synth
