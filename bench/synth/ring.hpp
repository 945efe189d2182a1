// SPDX-License-Identifier: Apache-2.0
// The points along a closed curve.
#pragma once

#include "bench/synth/surface_grid.hpp"

#include <cstdint>
#include <functional>

namespace lacuna::synth {

// Returns the loop without the shorter way between two visits of one point, until each point has one visit.
NumberLoop without_returns(NumberLoop loop);

// Returns the values of `nearest` as its argument goes around the outline, each once, in that order. A value
// that comes back later keeps one visit, and the shorter way from one to the other is left out. At a corner,
// the nearest points of both sides can be one point, and the point in the corner another.
NumberLoop ring_along(const Outline& outline, const std::function<std::uint64_t(GridPosition)>& nearest);

}  // namespace lacuna::synth
