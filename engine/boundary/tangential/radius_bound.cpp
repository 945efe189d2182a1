#include "engine/boundary/tangential/radius_bound.hpp"

#include "engine/simd/sort.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace lacuna::tangential {
namespace {

constexpr Batch<double> kBeyondAll = [] {
  Batch<double> row{};
  for (double& number : row.at) number = std::numeric_limits<double>::infinity();
  return row;
}();

using Counts = std::array<std::size_t, kBatchSize>;

}  // namespace

std::array<Sampling, kBatchSize> samplings_of(std::span<const FoundStar> stars,
                                              const TangentialConfig& config) {
  std::size_t most = 0;
  for (const FoundStar& star : stars) most = std::max(most, star.size());
  std::vector<Batch<double>> many;
  std::array<Batch<double>, 16> few;
  if (most > few.size()) many.resize(most);
  const std::span<Batch<double>> balls(many.empty() ? few.data() : many.data(), most);
  std::fill(balls.begin(), balls.end(), kBeyondAll);
  Counts counts{};
  for (std::size_t i = 0; i < stars.size(); ++i) {
    for (std::size_t vertex = 0; vertex < stars[i].size(); ++vertex) {
      const double ball = stars[i][vertex].radius;
      balls[counts[i]].at[i] = ball <= config.hole_radius ? ball : kBeyondAll.at[i];
      counts[i] += ball <= config.hole_radius;
    }
  }
  sort_rows(balls.data(), *std::max_element(counts.begin(), counts.end()));
  std::array<Sampling, kBatchSize> samplings{};
  for (std::size_t i = 0; i < stars.size(); ++i) {
    if (stars[i].size() == 0) continue;
    samplings[i].distance = stars[i].distance();
    if (counts[i] == 0) continue;
    const double median = balls[counts[i] / 2].at[i];
    samplings[i].circle = median * samplings[i].distance;
    samplings[i].spread = (median - balls[0].at[i]) * samplings[i].distance;
  }
  return samplings;
}

void RadiusBounder::find() {
  std::size_t rows = 0;
  for (const Surroundings& p : points_) rows = std::max(rows, p.neighbours.size() + 1);
  if (circles_.size() < rows) {
    circles_.resize(rows);
    spreads_.resize(rows);
  }
  std::fill_n(circles_.begin(), rows, kBeyondAll);
  std::fill_n(spreads_.begin(), rows, kBeyondAll);
  Counts counts{};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto add = [&](LocalIndex q) {
      const Sampling& sampling = samplings_[q];
      circles_[counts[i]].at[i] = sampling.circle > 0 ? sampling.circle : kBeyondAll.at[i];
      spreads_[counts[i]].at[i] = sampling.circle > 0 ? sampling.spread : kBeyondAll.at[i];
      counts[i] += sampling.circle > 0;
    };
    add(points_[i].point);
    for (const LocalIndex q : points_[i].neighbours) add(q);
  }
  rows = *std::max_element(counts.begin(), counts.end());
  sort_rows(circles_.data(), rows);
  sort_rows(spreads_.data(), rows);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double distance = samplings_[points_[i].point].distance;
    bounds_[i] = {};
    if (distance == 0) continue;
    const double most = config_.most_radius * distance;
    const double circle = std::min(circles_[counts[i] / 2].at[i], most);
    const double spread = std::min(spreads_[counts[i] / 2].at[i], most);
    const double fine = (config_.max_radius * circle + spread) / distance;
    bounds_[i] = {static_cast<float>(fine), static_cast<float>(config_.coarse_bound * fine)};
  }
}

}  // namespace lacuna::tangential
