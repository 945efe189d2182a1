#include "engine/criteria/direction_gap.hpp"

#include "engine/core/dispatch.hpp"
#include "engine/core/vector_math.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Directions nearer than this are one direction (its nearest neighbour stands for it), gaps nearer than this
// are equally large: exact symmetries of the points must not be decided by rounding.
constexpr double kSame = 1e-9;

// A neighbour whose projection is shorter than this share of its distance projects onto p.
constexpr double kNoDirection = 1e-12;

struct TangentPlane {
  Eigen::Vector3d normal, u, v;
  double cos_cone;
};

// Projects every neighbour; those without a stable direction get a place outside of the plane: NaN.
// Returns how many these are.
LACUNA_VECTORISED
std::uint64_t project(const Offsets& offsets, const TangentPlane& plane, double* px, double* py) {
  const double nx = plane.normal.x(), ny = plane.normal.y(), nz = plane.normal.z();
  const double ux = plane.u.x(), uy = plane.u.y(), uz = plane.u.z();
  const double vx = plane.v.x(), vy = plane.v.y(), vz = plane.v.z();
  const double cos_cone = plane.cos_cone;
  const double* const ox = offsets.x.data();
  const double* const oy = offsets.y.data();
  const double* const oz = offsets.z.data();
  const double* const distance = offsets.distance.data();
  const std::size_t count = offsets.size();
  for (std::size_t i = 0; i < lanes(count); ++i) {
    const double height = (nx * ox[i] + ny * oy[i]) + nz * oz[i];
    const double x = (ux * ox[i] + uy * oy[i]) + uz * oz[i];
    const double y = (vx * ox[i] + vy * oy[i]) + vz * oz[i];
    const double shortest = kNoDirection * distance[i];
    const double steep = std::abs(height) > cos_cone * distance[i] ? 1 : 0;
    const double unstable = x * x + y * y <= shortest * shortest ? 1 : steep;
    px[i] = unstable > 0 ? std::numeric_limits<double>::quiet_NaN() : x;
    py[i] = y;
  }
  std::uint64_t without = 0;
  for (std::size_t i = 0; i < count; ++i) without += px[i] != px[i];
  return without;
}

// Directions of the neighbours that have one, sorted by angle, then by rank.
void sort_directions(const Offsets& offsets, const TangentPlane& plane, Directions& d) {
  const std::size_t neighbours = offsets.size();
  if (d.x.size() < neighbours) {
    for (auto* column : {&d.x, &d.y, &d.angle}) column->resize(lanes(neighbours));
    for (auto* column : {&d.rank, &d.place}) column->resize(lanes(neighbours));
  }
  const std::size_t count = neighbours - project(offsets, plane, d.x.data(), d.y.data());
  if (count == neighbours) {
    std::iota(d.rank.begin(), d.rank.begin() + static_cast<std::ptrdiff_t>(count), 0u);
  } else {
    std::size_t kept = 0;
    for (std::uint32_t rank = 0; rank < neighbours; ++rank) {
      if (std::isnan(d.x[rank])) continue;
      d.x[kept] = d.x[rank];
      d.y[kept] = d.y[rank];
      d.rank[kept++] = rank;
    }
  }
  atan2_each(d.y.data(), d.x.data(), count, d.angle.data());

  // Each to its place; equal angles fight for one and leave another empty.
  count_smaller(d.angle.data(), count, d.place.data());
  d.sorted.assign(count, {0, DirectionGap::kNone});
  for (std::size_t i = 0; i < count; ++i) d.sorted[d.place[i]] = {d.angle[i], d.rank[i]};
  bool distinct = true;
  for (const Direction& direction : d.sorted) distinct &= direction.rank != DirectionGap::kNone;
  if (distinct) return;
  for (std::size_t i = 0; i < count; ++i) d.sorted[i] = {d.angle[i], d.rank[i]};
  std::sort(d.sorted.begin(), d.sorted.end(), [](const Direction& a, const Direction& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.rank < b.rank;
  });
}

// Runs of directions each within kSame of the one before, across pi too, become one.
void merge_runs(const std::vector<Direction>& sorted, std::vector<Direction>& merged) {
  const std::size_t m = sorted.size();
  const auto before = [&](std::size_t i) {
    return i == 0 ? sorted[0].angle - sorted[m - 1].angle + kTurn : sorted[i].angle - sorted[i - 1].angle;
  };
  // Start behind a wider gap, so that no run is cut, and go round once.
  std::size_t start = 0;
  while (start < m && before(start) <= kSame) ++start;
  if (start == m) start = 0;  // all are one direction
  merged.clear();
  for (std::size_t step = 0; step < m; ++step) {
    const std::size_t i = (start + step) % m;
    if (step == 0 || before(i) > kSame) {
      merged.push_back(sorted[i]);
    } else if (sorted[i].rank < merged.back().rank) {
      merged.back() = sorted[i];
    }
  }
}

// visit(turn, i) for the turn from each direction to the next, the last to the first.
template <class Visit>
void for_each_turn(const std::vector<Direction>& directions, Visit&& visit) {
  const std::size_t last = directions.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double turn = directions[i < last ? i + 1 : 0].angle - directions[i].angle;
    visit(turn > 0 ? turn : turn + kTurn, i);
  }
}

double largest_turn(const std::vector<Direction>& directions) {
  double largest = 0;
  for_each_turn(directions, [&](double turn, std::size_t) { largest = std::max(largest, turn); });
  return largest;
}

// Of gaps as large as the largest, the one whose pair, nearer neighbour first, comes first.
DirectionGap choose_gap(const std::vector<Direction>& directions, double largest, std::size_t used) {
  DirectionGap gap{.size = largest, .used = used};
  for_each_turn(directions, [&](double turn, std::size_t i) {
    if (turn < largest - kSame) return;
    const std::uint32_t a = directions[i].rank, b = directions[i + 1 < directions.size() ? i + 1 : 0].rank;
    const std::pair<std::uint32_t, std::uint32_t> pair = std::minmax(a, b);
    if (pair < std::pair(gap.near, gap.far)) std::tie(gap.near, gap.far) = pair;
  });
  return gap;
}

}  // namespace

DirectionGap largest_gap(const Offsets& offsets, const Eigen::Vector3d& normal, double cos_cone,
                         Directions& directions) {
  const Eigen::Vector3d u = normal.unitOrthogonal();
  sort_directions(offsets, {normal, u, normal.cross(u), cos_cone}, directions);
  const std::vector<Direction>& sorted = directions.sorted;
  const std::size_t used = sorted.size();
  if (used == 0) return {};
  double smallest = sorted.front().angle - sorted.back().angle + kTurn;
  for (std::size_t i = 0; i + 1 < used; ++i)
    smallest = std::min(smallest, sorted[i + 1].angle - sorted[i].angle);
  if (smallest > kSame && used > 1) return choose_gap(sorted, largest_turn(sorted), used);

  const std::vector<Direction>& merged = directions.merged;
  merge_runs(sorted, directions.merged);
  if (merged.size() > 1) return choose_gap(merged, largest_turn(merged), used);
  return {.size = kTurn, .used = used, .near = merged[0].rank, .far = merged[0].rank};
}

}  // namespace lacuna
