// SPDX-License-Identifier: Apache-2.0
#include "tools/run/scan_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <spdlog/fmt/fmt.h>

namespace lacuna::tools {
namespace {

constexpr double kWide = 0.5;         // step over the distance to the neighbours
constexpr double kApart = 10;         // likewise; wider gaps are between surfaces
constexpr double kLayers = 0.25;      // share of the points whose surface lies across the steps
constexpr double kDuplicates = 0.28;  // of the points, where half of all share a place at random

// Returns the distance from the farthest coordinate of single precision to the next one.
double step_of_single_precision(const Eigen::AlignedBox3d& bounds) {
  const double farthest = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  const auto single = static_cast<float>(farthest);
  return static_cast<double>(std::nextafter(single, std::numeric_limits<float>::infinity()) - single);
}

struct Sample {
  std::array<std::vector<double>, 3> coordinates;
  std::array<std::uint64_t, 3> across{};  // points whose normal is nearest to the axis
};

Sample sample_of(const Detection& detection) {
  constexpr std::uint64_t kMost = 100'000;
  const std::uint64_t step = detection.sampled_points / kMost + 1;
  Sample sample;
  std::uint64_t i = 0;
  detection.for_each_sampled_point([&](const SampledPoint& point) {
    if (i++ % step != 0) return;
    const Eigen::Vector3d position = point.position();
    std::size_t nearest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sample.coordinates[axis].push_back(position[static_cast<Eigen::Index>(axis)]);
      if (std::abs(point.normal[axis]) > std::abs(point.normal[nearest])) nearest = axis;
    }
    ++sample.across[nearest];
  });
  return sample;
}

// Returns the median over the points of the gap to the next value; 0 for fewer than three values.
double step_of(std::vector<double> values, double distance) {
  constexpr double kSame = 1e-3;
  std::ranges::sort(values);
  std::vector<std::pair<double, std::size_t>> gaps;  // behind so many points
  std::size_t points = 1;
  for (std::size_t i = 1; i < values.size(); ++i, ++points) {
    if (values[i] - values[i - 1] <= kSame * distance) continue;
    gaps.emplace_back(values[i] - values[i - 1], points);
    points = 0;
  }
  if (gaps.size() < 2) return 0;
  std::ranges::sort(gaps);
  std::size_t below = 0;
  for (const auto& [gap, behind] : gaps)
    if (2 * (below += behind) >= values.size() - points) return gap;
  return gaps.back().first;
}

}  // namespace

std::string steps_warning(const Detection& detection, bool is_single_precision) {
  const Summary& summary = detection.summary;
  const double distance = summary.median_distance;
  const Eigen::AlignedBox3d& bounds = summary.strays.rest;
  if (!(distance > 0) || bounds.isEmpty()) return "";
  const auto points = static_cast<double>(summary.counts.points - summary.counts.dropped);
  const double shared = static_cast<double>(summary.counts.duplicates) / points;
  const Sample sample = sample_of(detection);
  double widest = is_single_precision ? step_of_single_precision(bounds) : 0;
  bool is_wide = widest > kWide * distance;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = step_of(sample.coordinates[axis], distance);
    if (!(step > kWide * distance && step < kApart * distance)) continue;
    const auto across = static_cast<double>(sample.across[axis]);
    const bool are_layers = across > kLayers * static_cast<double>(sample.coordinates[axis].size());
    if (!are_layers && !(shared > kDuplicates)) continue;
    is_wide = true;
    widest = std::max(widest, step);
  }
  if (!is_wide) return "";
  return fmt::format(
      "coordinates are in steps of {:g}, and neighbours are {:g} apart{}; the scan needs finer steps, such "
      "as "
      "a smaller scale in LAS, double precision, or coordinates near 0",
      widest, distance,
      shared > kDuplicates
          ? fmt::format("; {} % of the points are at places of others", std::lround(100 * shared))
          : "");
}

}  // namespace lacuna::tools
