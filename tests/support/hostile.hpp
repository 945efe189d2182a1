// SPDX-License-Identifier: Apache-2.0
// Large clouds whose points are spread so unevenly that memory per place has no bound by itself.
#pragma once

#include "tests/support/clouds.hpp"

#include <cstdint>

namespace lacuna {

// n random points of a wavy sheet over the unit square.
Cloud rough_sheet(int n, std::uint64_t seed);

// n random points in the unit cube: no surface at all.
Cloud volume(int n, std::uint64_t seed);

// The rough sheet, nine tenths of it shrunk to a millionth.
Cloud cluster(int n, std::uint64_t seed);

// A cluster whose shrunk part is a volume.
Cloud volume_cluster(int n, std::uint64_t seed);

// n points of a plane about the origin, as many in each decade of distance from 1e-6 to 1.
Cloud log_uniform(int n, std::uint64_t seed);

// n random points on a line.
Cloud random_line(int n, std::uint64_t seed);

// The rough sheet with 24 in 25 points at the origin, as scanners write for rays without a return.
Cloud zeros(int n, std::uint64_t seed);

// The rough sheet with one in 100 points anywhere, up to 1e6 away and often farther.
Cloud one_percent_far(int n, std::uint64_t seed);

}  // namespace lacuna
