// SPDX-License-Identifier: Apache-2.0
// Drawn truths: rings of points in the plane, loops along parts of them, and rectangles of a grid.
#pragma once

#include "io/explain/matching/match_loops.hpp"
#include "tests/support/test.hpp"

namespace lacuna::matching {

struct Drawing {
  std::vector<Eigen::Vector3d> positions;

  // A regular polygon of n points, a unit apart. Returns their ids, in order.
  matching::LoopIds ring(std::uint64_t n, double x, double y) {
    const double radius = 0.5 / std::sin(std::numbers::pi / static_cast<double>(n));
    matching::LoopIds ids;
    for (std::uint64_t i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
      ids.push_back(positions.size());
      positions.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle), 0);
    }
    return ids;
  }

  std::uint64_t point(double x, double y, double z = 0) {
    positions.emplace_back(x, y, z);
    return positions.size() - 1;
  }
};

// The first points of a loop.
inline matching::LoopIds part(const matching::LoopIds& loop, double share) {
  const auto count = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(loop.size())));
  return {loop.begin(), loop.begin() + count};
}

// The places of a grid around a rectangle, from its lower left corner on, counterclockwise.
inline std::vector<std::array<int, 2>> places_around(int x, int y, int width, int height) {
  std::vector<std::array<int, 2>> places;
  for (int i = 0; i < width; ++i) places.push_back({x + i, y});
  for (int i = 0; i < height; ++i) places.push_back({x + width, y + i});
  for (int i = width; i > 0; --i) places.push_back({x + i, y + height});
  for (int i = height; i > 0; --i) places.push_back({x, y + i});
  return places;
}

}  // namespace lacuna::matching
