// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loop_order.hpp"

#include "engine/run/error.hpp"
#include "tools/matching/point_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace lacuna::evaluation {
namespace {

constexpr std::size_t kLeastPoints = 16;
constexpr std::size_t kMostTaken = 1 << 12;  // points whose nearest one is searched
constexpr double kSpacings = 10, kTimes = 8;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  if (values.empty()) return 0;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_edge(const LoopIds& loop, const Truth& truth) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double length =
        (truth.positions[loop[i]] - truth.positions[loop[(i + 1) % loop.size()]]).stableNorm();
    if (length >= 0) lengths.push_back(length);  // of finite points
  }
  return median(std::move(lengths));
}

double median_nearest(const LoopIds& loop, const Truth& truth) {
  std::vector<std::uint64_t> places;
  for (const std::uint64_t id : loop) {
    if (truth.positions[id].allFinite()) places.push_back(truth.stand_ins[id]);
  }
  std::ranges::sort(places);
  const auto [end, last] = std::ranges::unique(places);
  places.erase(end, last);
  std::vector<Eigen::Vector3d> points;
  for (const std::uint64_t place : places) points.push_back(truth.positions[place]);
  const PointTree tree(points);
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kMostTaken + 1) {
    const std::vector<double> nearest = tree.nearest_distances(points[i], 2);
    if (nearest.size() == 2) distances.push_back(nearest[1]);
  }
  return median(std::move(distances));
}

}  // namespace

void check_order(const Result& result, const Truth& truth) {
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    const LoopIds& loop = result.loops[i];
    if (loop.size() < kLeastPoints) continue;
    const double edge = median_edge(loop, truth);
    if (edge <= kSpacings * truth.spacing) continue;
    const double nearest = median_nearest(loop, truth);
    if (edge <= kTimes * nearest) continue;
    std::ostringstream message;
    message.precision(3);
    message << result.file.string() << ": loop " << i
            << " (from 0): its points are not in order along a curve: half of "
            << "its " << loop.size() << " edges are longer than " << edge << ", and the nearest points only "
            << nearest << " apart; the ids of a loop must follow its curve";
    throw Error(message.str());
  }
}

}  // namespace lacuna::evaluation
