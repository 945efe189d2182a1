// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/random_positions.hpp"

#include "bench/synth/ring.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace lacuna::synth {

namespace {

// The probability that a Poisson number with mean 1 is k or less.
constexpr auto kAtMost = [] {
  std::array<double, RandomPositions::kMostInSquare> sums{};
  double term = 0.36787944117144233;  // 1/e
  double sum = 0;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    sum += term;
    sums[k] = sum;
    term /= static_cast<double>(k + 1);
  }
  return sums;
}();

std::int64_t wrapped(std::int64_t index, std::int64_t size) {
  const std::int64_t rest = index % size;
  return rest < 0 ? rest + size : rest;
}

}  // namespace

// An open side of n nodes has n - 1 squares between them. On panels the nodes are the middles of the squares.
RandomPositions::RandomPositions(const SurfaceGrid& grid, const HoleField& holes,
                                 const SurfaceOptions& options)
    : grid_(grid),
      holes_(holes),
      rows_(grid.wrap_rows ? grid.rows : grid.rows - 1),
      columns_(grid.wrap_columns ? grid.columns : grid.columns - 1),
      corner_(grid.panels > 1 ? -0.5 : 0),
      count_(options.seed, 3),
      place_(options.seed, 4),
      kept_(options.seed, 5) {}

std::uint64_t RandomPositions::points_in(std::uint64_t square) const {
  const double draw = count_.uniform(square);
  std::uint64_t count = 0;
  while (count < kAtMost.size() && draw >= kAtMost[count]) ++count;
  return count;
}

std::optional<GridPosition> RandomPositions::at(std::uint64_t number) const {
  const std::uint64_t square = number / kMostInSquare;
  if (number % kMostInSquare >= points_in(square)) return std::nullopt;
  const GridPosition place{corner_ + static_cast<double>(square / columns_) + place_.uniform(2 * number),
                           corner_ + static_cast<double>(square % columns_) + place_.uniform(2 * number + 1)};
  if (grid_.stride > 1 && place.column > grid_.step_column &&
      kept_.uniform(number) * grid_.stride * grid_.stride >= 1)
    return std::nullopt;
  if (holes_.takes(place.row, place.column)) return std::nullopt;
  return place;
}

// The squares up to `reach` from the place's own hold all points up to that distance.
std::uint64_t RandomPositions::nearest(GridPosition place) const {
  const auto rows = static_cast<std::int64_t>(rows_), columns = static_cast<std::int64_t>(columns_);
  const auto middle_row = static_cast<std::int64_t>(std::floor(place.row - corner_));
  const auto middle_column = static_cast<std::int64_t>(std::floor(place.column - corner_));
  std::uint64_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::int64_t reach = 1; least > static_cast<double>(reach * reach); ++reach) {
    for (std::int64_t row = middle_row - reach; row <= middle_row + reach; ++row) {
      if (!grid_.wrap_rows && (row < 0 || row >= rows)) continue;
      for (std::int64_t column = middle_column - reach; column <= middle_column + reach; ++column) {
        if (!grid_.wrap_columns && (column < 0 || column >= columns)) continue;
        const std::int64_t near_row = wrapped(row, rows), near_column = wrapped(column, columns);
        const auto square = static_cast<std::uint64_t>(near_row * columns + near_column);
        const std::uint64_t end = square * kMostInSquare + points_in(square);
        for (std::uint64_t number = square * kMostInSquare; number < end; ++number) {
          const std::optional<GridPosition> point = at(number);
          if (!point) continue;
          const double down = point->row + static_cast<double>(row - near_row) - place.row;
          const double across = point->column + static_cast<double>(column - near_column) - place.column;
          const double squared = down * down + across * across;
          if (squared >= least) continue;
          least = squared;
          best = number;
        }
      }
    }
  }
  return best;
}

std::vector<NumberLoop> RandomPositions::true_loops() const {
  const auto nearest_to = [this](GridPosition place) { return nearest(place); };
  std::vector<NumberLoop> loops;
  for (std::size_t hole = 0; hole < holes_.size(); ++hole)
    loops.push_back(ring_along(holes_.outline(hole), nearest_to));
  for (const Outline& edge : outer_edges(grid_)) loops.push_back(ring_along(edge, nearest_to));
  return loops;
}

}  // namespace lacuna::synth
