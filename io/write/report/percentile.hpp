// SPDX-License-Identifier: Apache-2.0
// The value at a share of all values, in ascending order.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace lacuna::io {

// `share` is from 0 to 1. There is at least one value; the order of the values changes. Cost: linear.
inline float percentile(std::vector<float>& values, double share) {
  const auto at = values.begin() + std::llround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace lacuna::io
