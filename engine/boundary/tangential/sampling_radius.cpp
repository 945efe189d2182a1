// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/sampling_radius.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace lacuna::tangential {

void RadiiAround::add(const ScaledRadii& radii) {
  for (const float radius : radii.star.radii) {
    if (radius > std::numeric_limits<float>::max()) break;  // the others are infinite, too
    radii_.push_back(radius * radii.distance);
  }
}

double RadiiAround::sampling_radius(double bound) const {
  std::array<std::uint32_t, kSteps + 1> counts{};  // by how many steps they exceed; the last: not within
  const double per_step = kSteps / bound;
  for (const double radius : radii_)
    ++counts[static_cast<std::size_t>(std::min(radius * per_step, double{kSteps}))];
  const std::size_t count = radii_.size() - counts[kSteps], rank = count * 9 / 10;
  if (count == 0) return bound;
  std::size_t step = 0;
  for (std::size_t below = counts[0]; below <= rank; below += counts[step]) ++step;
  return static_cast<double>(step + 1) / kSteps * bound;
}

}  // namespace lacuna::tangential
