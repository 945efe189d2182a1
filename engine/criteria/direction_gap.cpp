#include "engine/criteria/direction_gap.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna {
namespace {

// Directions nearer than this are one direction (its nearest neighbour stands for it), gaps nearer than this
// are equally large: exact symmetries of the points must not be decided by rounding.
constexpr double kSame = 1e-9;

// A neighbour whose projection is shorter than this share of its distance projects onto p.
constexpr double kNoDirection = 1e-12;

std::pair<std::uint32_t, std::uint32_t> ordered(std::uint32_t a, std::uint32_t b) {
  return std::minmax(a, b);
}

}  // namespace

DirectionGap largest_gap(std::span<const Eigen::Vector3d> offsets, std::span<const double> distances,
                         const Eigen::Vector3d& normal, double cos_cone, std::vector<Direction>& directions) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  directions.clear();
  for (std::uint32_t rank = 0; rank < offsets.size(); ++rank) {
    const Eigen::Vector3d& offset = offsets[rank];
    if (std::abs(normal.dot(offset)) > cos_cone * distances[rank]) continue;
    const double x = u.dot(offset), y = v.dot(offset);
    if (std::sqrt(x * x + y * y) <= kNoDirection * distances[rank]) continue;
    directions.push_back({std::atan2(y, x), rank});
  }
  DirectionGap gap{.used = directions.size()};
  if (directions.empty()) return gap;
  std::sort(directions.begin(), directions.end(), [](const Direction& a, const Direction& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.rank < b.rank;
  });

  // Start behind a gap wider than kSame, so that no run of one direction is cut, and go round once.
  const std::size_t m = directions.size();
  std::size_t start = 0;
  const auto before = [&](std::size_t i) {  // from the direction before to the i-th
    return i == 0 ? directions[0].angle - directions[m - 1].angle + kTurn
                  : directions[i].angle - directions[i - 1].angle;
  };
  while (start < m && before(start) <= kSame) ++start;
  if (start == m) start = 0;  // all are one direction

  thread_local std::vector<Direction> merged;
  merged.clear();
  for (std::size_t step = 0; step < m; ++step) {
    const std::size_t i = (start + step) % m;
    if (step == 0 || before(i) > kSame) {
      merged.push_back(directions[i]);
    } else if (directions[i].rank < merged.back().rank) {
      merged.back() = directions[i];
    }
  }

  if (merged.size() == 1) {
    gap.size = kTurn;
    gap.near = gap.far = merged[0].rank;
    return gap;
  }
  const auto gap_after = [&](std::size_t i) {
    const double turn = merged[(i + 1) % merged.size()].angle - merged[i].angle;
    return turn > 0 ? turn : turn + kTurn;
  };
  for (std::size_t i = 0; i < merged.size(); ++i) gap.size = std::max(gap.size, gap_after(i));
  auto best = std::make_pair(DirectionGap::kNone, DirectionGap::kNone);
  for (std::size_t i = 0; i < merged.size(); ++i) {
    if (gap_after(i) < gap.size - kSame) continue;
    best = std::min(best, ordered(merged[i].rank, merged[(i + 1) % merged.size()].rank));
  }
  std::tie(gap.near, gap.far) = best;
  return gap;
}

}  // namespace lacuna
