#include "engine/stages/ball_sizes.hpp"

#include "engine/core/sorting_network.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace lacuna {
namespace {

constexpr double kCircles = 1.45, kScatters = 0.8, kLeastUnit = 0.1, kMostCircle = 0.5;

constexpr Eight kBeyondAll = [] {
  Eight row{};
  for (double& number : row.at) number = std::numeric_limits<double>::infinity();
  return row;
}();

using Counts = std::array<std::size_t, kEight>;

// The first `counts[i]` numbers of each point i, half of them up to the median.
void sort_halves(std::span<Eight> rows, const Counts& counts) {
  const std::size_t most = *std::max_element(counts.begin(), counts.end());
  if (most == 0) return;
  if (most <= kMostSortedRows) {
    fastest::sort_rows(rows.data(), most, most / 2 + 1);
    return;
  }
  for (std::size_t i = 0; i < kEight; ++i) {
    std::vector<double> numbers;
    for (std::size_t row = 0; row < counts[i]; ++row) numbers.push_back(rows[row].at[i]);
    std::sort(numbers.begin(), numbers.end());
    for (std::size_t row = 0; row < counts[i]; ++row) rows[row].at[i] = numbers[row];
  }
}

}  // namespace

std::array<Sampling, kEight> samplings_of(std::span<const FoundStar> stars) {
  Counts counts{};
  for (std::size_t i = 0; i < stars.size(); ++i) counts[i] = stars[i].size();
  std::vector<Eight> many;
  std::array<Eight, 16> few;
  const std::size_t most = *std::max_element(counts.begin(), counts.end());
  if (most > few.size()) many.resize(most);
  const std::span<Eight> balls(many.empty() ? few.data() : many.data(), most);
  std::fill(balls.begin(), balls.end(), kBeyondAll);
  for (std::size_t i = 0; i < stars.size(); ++i) {
    for (std::size_t corner = 0; corner < counts[i]; ++corner) balls[corner].at[i] = stars[i][corner].room;
  }
  sort_halves(balls, counts);
  std::array<Sampling, kEight> samplings{};
  for (std::size_t i = 0; i < stars.size(); ++i) {
    if (counts[i] == 0) continue;
    const double distance = stars[i].distance(), median = balls[counts[i] / 2].at[i];
    samplings[i] = {distance, median * distance, (median - balls[0].at[i]) * distance};
  }
  return samplings;
}

float room_beyond(const BallSize& size, const Sampling& own, float ball) {
  return static_cast<float>((ball * own.distance - size.radius) / size.unit);
}

void BallSizer::find() {
  std::size_t rows = 0;
  for (const Surroundings& p : points_) rows = std::max(rows, p.neighbours.size() + 1);
  if (circles_.size() < rows) {
    circles_.resize(rows);
    scatters_.resize(rows);
  }
  std::fill_n(circles_.begin(), rows, kBeyondAll);
  std::fill_n(scatters_.begin(), rows, kBeyondAll);
  Counts counts{};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto look_at = [&](LocalIndex q) {
      const Sampling& sampling = samplings_[q];
      circles_[counts[i]].at[i] = sampling.distance > 0 ? sampling.circle : kBeyondAll.at[i];
      scatters_[counts[i]].at[i] = sampling.distance > 0 ? sampling.scatter : kBeyondAll.at[i];
      counts[i] += sampling.distance > 0;
    };
    look_at(points_[i].point);
    for (const LocalIndex q : points_[i].neighbours) look_at(q);
  }
  sort_halves(circles_, counts);
  sort_halves(scatters_, counts);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double most = kMostCircle * samplings_[points_[i].point].distance;
    const double circle = std::min(circles_[counts[i] / 2].at[i], most);
    const double scatter = std::min(scatters_[counts[i] / 2].at[i], most);
    sizes_[i] = {kCircles * circle + kScatters * scatter, kLeastUnit * circle + scatter};
  }
}

}  // namespace lacuna
