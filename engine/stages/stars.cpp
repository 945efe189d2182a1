#include "engine/stages/stars.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace lacuna {
namespace {

// Larger ones say no more: there is room.
constexpr double kMostRoom = 8;

// In units of r^2: far above rounding, far below what a scanner can tell.
constexpr double kWeights = 1e-4;

// A number in [0, 1) that looks random.
double scatter(PointId id) {
  std::uint64_t mixed = (value(id) + 1) * 0x9e3779b97f4a7c15;
  mixed ^= mixed >> 29;
  mixed *= 0xbf58476d1ce4e5b9;
  return static_cast<double>(mixed >> 40) * 0x1p-24;
}

double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

Eigen::Vector3d vector(const double (&components)[3]) {
  return {components[0], components[1], components[2]};
}

}  // namespace

Seat seat_of(const Eigen::Vector3d& position, PointId id, const Evaluation& evaluation) {
  const double r = evaluation.mean_distance;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  if (evaluation.normal.allFinite())
    shift = evaluation.normal * evaluation.normal.dot(evaluation.mean_offset);
  return {{position.x(), position.y(), position.z()},
          {shift.x(), shift.y(), shift.z()},
          r,
          kWeights * scatter(id) * r * r};
}

std::span<const StarCorner<LocalIndex>> StarFinder::find(const Seat& at, const Eigen::Vector3d& normal,
                                                         std::span<const Seat> neighbours) {
  star_.clear();
  if (!normal.allFinite()) return star_;
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const Eigen::Vector3d position = vector(at.position), shift = vector(at.shift);
  double sum = at.mean_distance;
  seen_.clear();
  for (LocalIndex i = 0; i < neighbours.size(); ++i) {
    const Seat& q = neighbours[i];
    sum += q.mean_distance;
    const Eigen::Vector3d d = (vector(q.position) - position) + (vector(q.shift) - shift);
    // The weights make it a ball orthogonal to small balls around the points: any two views of four points
    // on one circle then agree on how it falls into triangles.
    const double power = d.squaredNorm() + (at.weight - q.weight);
    if (power > 0) seen_.push_back({d.dot(u) / power, d.dot(v) / power, i});
  }
  const double radius = kBall * sum / static_cast<double>(neighbours.size() + 1);

  // The convex hull, by Andrew's monotone chain.
  std::sort(seen_.begin(), seen_.end(), [](const Seen& a, const Seen& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.neighbour < b.neighbour;
  });
  const auto turns_left = [](const Seen& a, const Seen& b, const Seen& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  };
  hull_.clear();
  const auto add = [&](const Seen& next, std::size_t least) {
    while (hull_.size() > least && !turns_left(hull_[hull_.size() - 2], hull_.back(), next)) hull_.pop_back();
    hull_.push_back(next);
  };
  for (const Seen& next : seen_) add(next, 1);
  const std::size_t lower = hull_.size();
  for (std::size_t i = seen_.size(); i-- > 1;) add(seen_[i - 1], lower);
  if (hull_.size() < 4) return star_;  // the last is the first again

  for (std::size_t i = 0; i + 1 < hull_.size(); ++i) {
    const Seen &a = hull_[i], &b = hull_[i + 1];
    const double height = (a.x * b.y - a.y * b.x) / length(b.x - a.x, b.y - a.y);
    const double room = height > 0 ? std::min(1 / (2 * height * radius), kMostRoom) : kMostRoom;
    star_.push_back({a.neighbour, static_cast<float>(room)});
  }
  return star_;
}

Stars<LocalIndex> find_stars(const TilePoints& points, const Rows& neighbourhoods,
                             std::span<const Evaluation> evaluations, std::span<const Seat> seats,
                             std::span<const std::uint8_t> is_border) {
  Stars<LocalIndex> stars;
  stars.offsets.reserve(points.owned + 1);
  stars.corners.reserve(std::size_t{8} * points.owned);
  StarFinder finder;
  std::vector<Seat> around;
  for (LocalIndex p = 0; p < points.owned; ++p) {
    if (!is_border[p]) {
      const auto neighbours = neighbourhoods[p];
      around.clear();
      for (const LocalIndex q : neighbours) around.push_back(seats[q]);
      for (const auto& corner : finder.find(seats[p], evaluations[p].normal, around))
        stars.corners.push_back({neighbours[corner.point], corner.room});
    }
    stars.offsets.push_back(static_cast<std::uint32_t>(stars.corners.size()));
  }

  stars.agreements.resize(stars.corners.size(), Agreement::kRefused);
  for (LocalIndex p = 0; p < points.owned; ++p) {
    const auto star = stars[p];
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (star[i].room > 1) continue;
      const LocalIndex a = star[i].point, b = star[i + 1 < star.size() ? i + 1 : 0].point;
      if ((!is_border[a] && !has_triangle(stars[a], p, b)) ||
          (!is_border[b] && !has_triangle(stars[b], p, a)))
        continue;
      stars.agreements[stars.offsets[p] + i] =
          is_border[a] || is_border[b] ? Agreement::kOpen : Agreement::kAgreed;
    }
  }
  return stars;
}

}  // namespace lacuna
