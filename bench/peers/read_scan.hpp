// SPDX-License-Identifier: Apache-2.0
// Lacuna's own readers for the peers, so that the time of their own readers does not count.
#pragma once

#include <vector>

namespace lacuna::peers {

// Returns x y z of every point with finite coordinates, one after the other. Throws `lacuna::Error`.
std::vector<float> read_scan(const char* file);

}  // namespace lacuna::peers
