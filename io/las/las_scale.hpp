// SPDX-License-Identifier: Apache-2.0
// Scale and offset that hold the coordinates of several LAS files and of other points (io/las/las_join.hpp).
#pragma once

#include "io/las/las_join.hpp"

#include <array>

namespace lacuna::io {

struct LasScale {
  std::array<double, 3> scale, offset;
};

// Throws `Error` where there is none.
LasScale join_scales(const LasParts& parts);

// How a stored coordinate of one scale and offset becomes one of another: stored * factor + added. None: not
// by whole numbers.
struct LasStep {
  std::int64_t factor, added;
};
std::optional<LasStep> las_step(double scale, double offset, double to_scale, double to_offset);

}  // namespace lacuna::io
