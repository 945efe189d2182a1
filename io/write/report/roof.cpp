// SPDX-License-Identifier: Apache-2.0
#include "io/write/report/roof.hpp"

#include "io/write/report/percentile.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

constexpr int kCells = 24;            // along each side of the plan
constexpr float kLeastRoofed = 0.6f;  // share of the cells with something below their highest point
constexpr float kThickness = 0.12f;   // of a roof: share of the heights
constexpr float kLeastRoom = 0.4f;    // below a roof: share of the heights
constexpr float kNone = -std::numeric_limits<float>::infinity();

// Lowest and highest of most positions along an axis, so that a few outliers do not count.
std::pair<float, float> usual_range(const std::vector<Eigen::Vector3f>& positions, int axis) {
  std::vector<float> values;
  for (const Eigen::Vector3f& p : positions) values.push_back(p[axis]);
  const float low = percentile(values, 0.005), high = percentile(values, 0.995);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const float margin = 0.02f * (high - low);
  return {std::max(*least, low - margin), std::min(*most, high + margin)};
}

}  // namespace

std::optional<double> roof_height(const Scene& scene) {
  const std::vector<Eigen::Vector3f>& positions = scene.points.positions;
  if (positions.empty()) return std::nullopt;
  const std::pair<float, float> sides[] = {usual_range(positions, 0), usual_range(positions, 1)};
  const auto [bottom, top] = usual_range(positions, 2);
  const float tall = top - bottom;
  const auto cell_of = [&](const Eigen::Vector3f& p) -> std::optional<std::size_t> {
    std::size_t cell = 0;
    for (int axis = 0; axis < 2; ++axis) {
      const auto [low, high] = sides[axis];
      const float part = kCells * (p[axis] - low) / std::max(1e-30f, high - low);
      if (!(part >= 0 && part < kCells)) return std::nullopt;
      cell = cell * kCells + static_cast<std::size_t>(part);
    }
    return cell;
  };
  std::vector<float> highest(kCells * kCells, kNone);
  for (const Eigen::Vector3f& p : positions)
    if (const auto cell = cell_of(p); cell && p.z() <= top) highest[*cell] = std::max(highest[*cell], p.z());
  std::vector<bool> is_roofed(highest.size());
  for (const Eigen::Vector3f& p : positions) {
    if (const auto cell = cell_of(p))
      if (highest[*cell] > top - 2 * kThickness * tall && p.z() < highest[*cell] - kLeastRoom * tall)
        is_roofed[*cell] = true;
  }
  std::vector<float> roofs;
  std::ptrdiff_t occupied = 0;
  for (std::size_t cell = 0; cell < highest.size(); ++cell) {
    occupied += highest[cell] > kNone;
    if (is_roofed[cell]) roofs.push_back(highest[cell]);
  }
  if (roofs.empty() || static_cast<float>(roofs.size()) < kLeastRoofed * static_cast<float>(occupied))
    return std::nullopt;
  return scene.origin.z() + double(percentile(roofs, 0.05) - kThickness * tall);
}

}  // namespace lacuna::io
