// SPDX-License-Identifier: Apache-2.0
#include "engine/criteria/exact_fallback.hpp"

#include "engine/simd/maths.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace lacuna {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> offsets_of(const NeighbourBatch& batch, std::size_t point) {
  std::vector<Vector3d> offsets;
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch.counts.at[point]); ++i)
    offsets.emplace_back(batch.x[i].at[point], batch.y[i].at[point], batch.z[i].at[point]);
  return offsets;
}

double squared_length(const Vector3d& v) {
  return (v.x() * v.x() + v.y() * v.y()) + v.z() * v.z();
}

constexpr double kTurn = 2 * std::numbers::pi;

struct Direction {
  double angle;
  std::uint32_t rank;  // of the neighbour

  friend bool operator<(const Direction& a, const Direction& b) {
    return std::tie(a.angle, a.rank) < std::tie(b.angle, b.rank);
  }
};

// Returns the directions of the neighbours that have a stable one, sorted.
std::vector<Direction> sorted_directions(const std::vector<Vector3d>& offsets, const Vector3d& normal,
                                         double cos_cone) {
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Direction> directions;
  for (std::uint32_t rank = 0; rank < offsets.size(); ++rank) {
    const Vector3d& offset = offsets[rank];
    const double distance = std::sqrt(squared_length(offset));
    const double x = u.dot(offset), y = v.dot(offset), shortest = kNoDirection * distance;
    if (x * x + y * y <= shortest * shortest || std::abs(normal.dot(offset)) > cos_cone * distance) continue;
    directions.push_back({angle_of(y, x), rank});
  }
  std::sort(directions.begin(), directions.end());
  return directions;
}

// Unites runs of directions that are each within kSameDirection of the one before. Runs go across pi, too.
std::vector<Direction> unite_directions(const std::vector<Direction>& sorted) {
  const std::size_t m = sorted.size();
  const auto before = [&](std::size_t i) {
    return i == 0 ? sorted[0].angle - sorted[m - 1].angle + kTurn : sorted[i].angle - sorted[i - 1].angle;
  };
  // The search starts behind a wider gap, so that no run is cut, and goes round once.
  std::size_t start = 0;
  while (start < m && before(start) <= kSameDirection) ++start;
  if (start == m) start = 0;  // all are one direction
  std::vector<Direction> merged;
  for (std::size_t step = 0; step < m; ++step) {
    const std::size_t i = (start + step) % m;
    if (step == 0 || before(i) > kSameDirection) {
      merged.push_back(sorted[i]);
    } else if (sorted[i].rank < merged.back().rank) {
      merged.back() = sorted[i];
    }
  }
  return merged;
}

// Calls visit(turn, i) for the turn from each direction to the next, and from the last to the first.
template <class Visit>
void for_each_turn(const std::vector<Direction>& directions, Visit&& visit) {
  const std::size_t last = directions.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double turn = directions[i < last ? i + 1 : 0].angle - directions[i].angle;
    visit(turn > 0 ? turn : turn + kTurn, i);
  }
}

}  // namespace

LargestGap find_largest_gap_exactly(const NeighbourBatch& batch, std::size_t point, const double normal[3],
                                    double cos_cone) {
  const Vector3d n(normal[0], normal[1], normal[2]);
  const std::vector<Direction> sorted = sorted_directions(offsets_of(batch, point), n, cos_cone);
  LargestGap gap{.used = static_cast<double>(sorted.size())};
  if (sorted.empty()) return gap;
  const std::vector<Direction> directions = unite_directions(sorted);
  for_each_turn(directions, [&](double turn, std::size_t) { gap.size = std::max(gap.size, turn); });

  // Where several gaps are as large as the largest, the one whose pair comes first counts, nearer neighbour
  // first.
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::pair<std::uint32_t, std::uint32_t> first{kNone, kNone};
  for_each_turn(directions, [&](double turn, std::size_t i) {
    if (turn < gap.size - kSameDirection) return;
    const std::uint32_t a = directions[i].rank, b = directions[i + 1 < directions.size() ? i + 1 : 0].rank;
    first = std::min(first, {std::min(a, b), std::max(a, b)});
  });
  gap.near = first.first;
  gap.far = first.second;
  return gap;
}

PlaneFit fit_plane_exactly(const double covariance[6]) {
  const auto [xx, yy, zz, xy, xz, yz] =
      std::tie(covariance[0], covariance[1], covariance[2], covariance[3], covariance[4], covariance[5]);
  Eigen::Matrix3d matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(matrix);
  const Vector3d values = solver.eigenvalues(), normal = solver.eigenvectors().col(0);
  // The two smallest differ by no more than rounding noise: no plane fits better than another.
  constexpr double kSameEigenvalue = 1e-12;
  return {.eigenvalues = {values[2], values[1], values[0]},
          .normal = {normal.x(), normal.y(), normal.z()},
          .has_normal = values[1] - values[0] > kSameEigenvalue * values.sum()};
}

}  // namespace lacuna
