#include "engine/criteria/direction_gap.hpp"

#include "engine/core/dispatch.hpp"
#include "engine/core/vector_math.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
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
LACUNA_VECTORISED
void project(const Offsets& offsets, const TangentPlane& plane, double* px, double* py) {
  const double nx = plane.normal.x(), ny = plane.normal.y(), nz = plane.normal.z();
  const double ux = plane.u.x(), uy = plane.u.y(), uz = plane.u.z();
  const double vx = plane.v.x(), vy = plane.v.y(), vz = plane.v.z();
  const double* const ox = offsets.x.data();
  const double* const oy = offsets.y.data();
  const double* const oz = offsets.z.data();
  const double* const distance = offsets.distance.data();
  const std::size_t count = offsets.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double height = (nx * ox[i] + ny * oy[i]) + nz * oz[i];
    const double x = (ux * ox[i] + uy * oy[i]) + uz * oz[i];
    const double y = (vx * ox[i] + vy * oy[i]) + vz * oz[i];
    const double shortest = kNoDirection * distance[i];
    const bool steep = std::abs(height) > plane.cos_cone * distance[i];
    const bool onto_p = x * x + y * y <= shortest * shortest;
    px[i] = steep || onto_p ? std::numeric_limits<double>::quiet_NaN() : x;
    py[i] = y;
  }
}

// Directions of the neighbours that have one, sorted by angle, then by rank.
void sort_directions(const Offsets& offsets, const TangentPlane& plane, Directions& d) {
  const std::size_t neighbours = offsets.size();
  for (auto* column : {&d.x, &d.y, &d.angle}) column->resize(neighbours);
  for (auto* column : {&d.rank, &d.place}) column->resize(neighbours);
  project(offsets, plane, d.x.data(), d.y.data());
  std::size_t count = 0;
  for (std::uint32_t rank = 0; rank < neighbours; ++rank) {
    d.x[count] = d.x[rank];
    d.y[count] = d.y[rank];
    d.rank[count] = rank;
    count += !std::isnan(d.x[rank]);
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

double turn_after(const std::vector<Direction>& directions, std::size_t i) {
  const double turn = directions[i + 1 < directions.size() ? i + 1 : 0].angle - directions[i].angle;
  return turn > 0 ? turn : turn + kTurn;
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

// Of gaps as large as the largest, the one whose pair, nearer neighbour first, comes first.
DirectionGap choose_gap(const std::vector<Direction>& directions, std::size_t used) {
  DirectionGap gap{.used = used};
  for (std::size_t i = 0; i < directions.size(); ++i)
    gap.size = std::max(gap.size, turn_after(directions, i));
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (turn_after(directions, i) < gap.size - kSame) continue;
    const std::uint32_t a = directions[i].rank, b = directions[(i + 1) % directions.size()].rank;
    const std::pair<std::uint32_t, std::uint32_t> pair = std::minmax(a, b);
    if (pair < std::pair(gap.near, gap.far)) std::tie(gap.near, gap.far) = pair;
  }
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
  double smallest = kTurn;
  for (std::size_t i = 0; i + 1 < used; ++i) {
    smallest = std::min(smallest, sorted[i + 1].angle - sorted[i].angle);
  }
  smallest = std::min(smallest, sorted.front().angle - sorted.back().angle + kTurn);
  if (smallest > kSame && used > 1) return choose_gap(sorted, used);

  merge_runs(sorted, directions.merged);
  if (directions.merged.size() > 1) return choose_gap(directions.merged, used);
  const std::uint32_t only = directions.merged[0].rank;
  return {.size = kTurn, .used = used, .near = only, .far = only};
}

}  // namespace lacuna
