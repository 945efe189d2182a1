// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/test.hpp"

namespace lacuna::test {

// The places of a grid around a rectangle, from its lower left corner on, counterclockwise.
inline std::vector<std::array<int, 2>> places_around(int x, int y, int width, int height) {
  std::vector<std::array<int, 2>> places;
  for (int i = 0; i < width; ++i) places.push_back({x + i, y});
  for (int i = 0; i < height; ++i) places.push_back({x + width, y + i});
  for (int i = width; i > 0; --i) places.push_back({x + i, y + height});
  for (int i = height; i > 0; --i) places.push_back({x, y + i});
  return places;
}

}  // namespace lacuna::test
