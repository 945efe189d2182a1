// SPDX-License-Identifier: Apache-2.0
// Why the stations of a synthetic scan did not sample the inside of a hole, by the shapes of its scene.
#pragma once

#include "bench/synth/scanner.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/explain/stations/find_causes.hpp"
#include "tests/support/test.hpp"

namespace lacuna::test {

// Shares of the area, as in LoopCause; all 0 where a station samples all places. A place takes part where a
// shape has a surface within 5 cm.
std::array<double, io::kCauses> true_shares(std::span<const io::InnerSample> places,
                                            const synth::Scanner& scanner);

// The area of places on surfaces that the last station of the scanner samples.
double area_seen_by_last(std::span<const io::InnerSample> places, const synth::Scanner& scanner);

bool is_on_surface(const io::InnerSample& place, const synth::Scanner& scanner);

}  // namespace lacuna::test
