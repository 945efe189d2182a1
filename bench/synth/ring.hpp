// SPDX-License-Identifier: Apache-2.0
// The points along a closed curve.
#pragma once

#include "bench/synth/surface_grid.hpp"

#include <cstdint>
#include <functional>

namespace lacuna::synth {

// The loop without the shorter way between two visits of one point, until none is visited twice.
NumberLoop without_returns(NumberLoop loop);

// The values of `nearest` as its argument goes around the outline, each once, in that order. A value that
// comes back later keeps one visit, and the shorter way from one to the other is left out. At a corner, the
// nearest points of both sides can be one point, and the point in the corner another.
NumberLoop ring_along(const Outline& outline, const std::function<std::uint64_t(Place)>& nearest);

}  // namespace lacuna::synth
