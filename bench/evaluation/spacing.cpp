// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/spacing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <utility>

namespace lacuna::evaluation {
namespace {

constexpr std::size_t kNeighbours = 4;
constexpr std::size_t kMostTaken = 1 << 17;  // more points hardly move a median, and each takes microseconds

}  // namespace

double spacing_at(const Eigen::Vector3d& point, const PointTree& tree) {
  // The point itself is the first.
  const std::vector<double> distances = tree.nearest_distances(point, kNeighbours + 1);
  if (distances.size() < 2) return 0;
  return std::accumulate(distances.begin(), distances.end(), 0.) / static_cast<double>(distances.size() - 1);
}

double spacing_of_place(const Eigen::Vector3d& place, const PointTree& tree) {
  constexpr std::size_t kAround = 32;
  const std::vector<double> distances =
      tree.nearest_distances(place, kAround + 1);  // the first is the point's own
  if (distances.size() <= kAround) return 0;
  return distances.back() * std::sqrt(std::numbers::pi / kAround);  // a disc of as many squares
}

double median_spacing(std::span<const Eigen::Vector3d> points, const PointTree& tree) {
  if (points.size() < 2) return 0;
  std::vector<double> spacings;
  const std::size_t step = (points.size() - 1) / kMostTaken + 1;
  for (std::size_t i = 0; i < points.size(); i += step) spacings.push_back(spacing_at(points[i], tree));
  return median(std::move(spacings));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  if (values.empty()) return 0;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace lacuna::evaluation
