// SPDX-License-Identifier: Apache-2.0
// A small, fast PLY reader for the peers, so that the time of their own readers does not count.
#pragma once

#include <vector>

namespace lacuna::peers {

// Returns x y z of every vertex with finite coordinates, one after the other. Reads binary little-endian and
// ASCII files; elements before the vertices may only have scalars. Throws `std::runtime_error`.
std::vector<float> read_ply(const char* file);

}  // namespace lacuna::peers
