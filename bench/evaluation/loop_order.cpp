// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/loop_order.hpp"

#include "bench/evaluation/spacing.hpp"
#include "engine/run/error.hpp"
#include "io/explain/matching/nearest.hpp"

#include <cstddef>
#include <vector>

#include <spdlog/fmt/fmt.h>

namespace lacuna::evaluation {
namespace {

constexpr std::size_t kLeastPoints = 16;
constexpr std::size_t kMostTaken = 1 << 12;  // points whose nearest one is searched
constexpr double kSpacings = 10, kTimes = 8;

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
  sort_once(places);
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
    throw Error(fmt::format(
        "{}: loop {} (from 0): its points are not in order along a curve: half of its {} edges are longer "
        "than "
        "{:.3g}, and the nearest points only {:.3g} apart; the ids of a loop must follow its curve",
        result.file.string(), i, loop.size(), edge, nearest));
  }
}

}  // namespace lacuna::evaluation
