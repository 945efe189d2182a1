// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/radius_bound.hpp"

#include "engine/simd/sort.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace lacuna::tangential {
namespace {

// Pads the lanes that have fewer numbers than others: it sorts behind all of them.
constexpr Batch<double> kBeyondAll = [] {
  Batch<double> batch{};
  for (double& number : batch.at) number = std::numeric_limits<double>::infinity();
  return batch;
}();

using Counts = std::array<std::size_t, kBatchSize>;

}  // namespace

std::array<Sampling, kBatchSize> samplings_of(std::span<const FoundStar> stars,
                                              const TangentialConfig& config) {
  // One lane for each star, one element for each of its triangles. Few stars have more than 16.
  std::size_t most = 0;
  for (const FoundStar& star : stars) most = std::max(most, star.size());
  std::vector<Batch<double>> many;
  std::array<Batch<double>, 16> few;
  if (most > few.size()) many.resize(most);
  const std::span<Batch<double>> radii(many.empty() ? few.data() : many.data(), most);
  std::fill(radii.begin(), radii.end(), kBeyondAll);
  // Take the circumradii that are not of holes.
  Counts counts{};
  for (std::size_t i = 0; i < stars.size(); ++i) {
    for (std::size_t vertex = 0; vertex < stars[i].size(); ++vertex) {
      const double radius = stars[i][vertex].radius;
      radii[counts[i]].at[i] = radius <= config.hole_radius ? radius : kBeyondAll.at[i];
      counts[i] += radius <= config.hole_radius;
    }
  }
  sort_batches(radii.data(), *std::max_element(counts.begin(), counts.end()));
  // Radii are in mean distances, samplings are lengths.
  std::array<Sampling, kBatchSize> samplings{};
  for (std::size_t i = 0; i < stars.size(); ++i) {
    if (stars[i].size() == 0) continue;
    samplings[i].distance = stars[i].distance();
    if (counts[i] == 0) continue;
    const double median = radii[counts[i] / 2].at[i];
    samplings[i].median_radius = median * samplings[i].distance;
    samplings[i].spread = (median - radii[0].at[i]) * samplings[i].distance;
  }
  return samplings;
}

void RadiusBounder::find() {
  std::size_t most = 0;
  for (const PointAndNeighbours& p : points_) most = std::max(most, p.neighbours.size() + 1);
  if (medians_.size() < most) {
    medians_.resize(most);
    spreads_.resize(most);
  }
  std::fill_n(medians_.begin(), most, kBeyondAll);
  std::fill_n(spreads_.begin(), most, kBeyondAll);
  // One lane for each point: the numbers of the point and of its neighbours that have any.
  Counts counts{};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto add = [&](LocalIndex q) {
      const Sampling& sampling = samplings_[q];
      medians_[counts[i]].at[i] = sampling.median_radius > 0 ? sampling.median_radius : kBeyondAll.at[i];
      spreads_[counts[i]].at[i] = sampling.median_radius > 0 ? sampling.spread : kBeyondAll.at[i];
      counts[i] += sampling.median_radius > 0;
    };
    add(points_[i].point);
    for (const LocalIndex q : points_[i].neighbours) add(q);
  }
  most = *std::max_element(counts.begin(), counts.end());
  sort_batches(medians_.data(), most);
  sort_batches(spreads_.data(), most);
  // M and S are the medians, limited to a share of the mean distance (method.md, C.2).
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double distance = samplings_[points_[i].point].distance;
    bounds_[i] = {};
    if (distance == 0) continue;
    const double most = config_.most_radius * distance;
    const double median_radius = std::min(medians_[counts[i] / 2].at[i], most);
    const double spread = std::min(spreads_[counts[i] / 2].at[i], most);
    const double fine = (config_.max_radius * median_radius + spread) / distance;
    bounds_[i] = {static_cast<float>(fine), static_cast<float>(config_.coarse_bound * fine)};
  }
}

}  // namespace lacuna::tangential
