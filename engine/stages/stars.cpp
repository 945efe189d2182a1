#include "engine/stages/stars.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna {
namespace {

// In units of r^2: far above rounding, far below what a scanner can tell.
constexpr double kWeights = 1e-4;

// A number in [0, 1) that looks random.
double scatter(PointId id) {
  std::uint64_t mixed = (value(id) + 1) * 0x9e3779b97f4a7c15;
  mixed ^= mixed >> 29;
  mixed *= 0xbf58476d1ce4e5b9;
  return static_cast<double>(mixed >> 40) * 0x1p-24;
}

Vector<double> vector(const double (&components)[3]) {
  return {components[0], components[1], components[2]};
}

// Where a point sees a neighbour, inverted.
struct View {
  double x, y;
  LocalIndex neighbour;
};

struct Views {
  std::vector<View> all;
  double radius;  // of the ball
};

Views look_around(std::span<const Seat> seats, const StarQuery& query) {
  const Seat& at = seats[query.point];
  const Frame<double> frame = frame_of(Vector<double>{query.normal.x(), query.normal.y(), query.normal.z()});
  Views views;
  double sum = at.mean_distance;
  for (LocalIndex i = 0; i < query.neighbours.size(); ++i) {
    const Seat& q = seats[query.neighbours[i]];
    sum += q.mean_distance;
    const Vector<double> d =
        (vector(q.position) - vector(at.position)) + (vector(q.shift) - vector(at.shift));
    // The weights make it a ball orthogonal to small balls around the points: any two views of four points
    // on one circle then agree on how it falls into triangles.
    const double power = dot(d, d) + (at.weight - q.weight);
    const double inverse = 1 / power;
    const View view{dot(d, frame.u) * inverse, dot(d, frame.v) * inverse, i};
    if (power > 0 && std::isfinite(view.x) && std::isfinite(view.y)) views.all.push_back(view);
  }
  views.radius = kBall * sum / static_cast<double>(query.neighbours.size() + 1);
  return views;
}

// The convex hull, by Andrew's monotone chain; the last is the first again.
std::vector<View> hull_of(std::vector<View> views) {
  std::sort(views.begin(), views.end(), [](const View& a, const View& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.neighbour < b.neighbour;
  });
  const auto turns_left = [](const View& a, const View& b, const View& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  };
  std::vector<View> hull;
  const auto add = [&](const View& next, std::size_t least) {
    while (hull.size() > least && !turns_left(hull[hull.size() - 2], hull.back(), next)) hull.pop_back();
    hull.push_back(next);
  };
  for (const View& next : views) add(next, 1);
  const std::size_t lower = hull.size();
  for (std::size_t i = views.size(); i-- > 1;) add(views[i - 1], lower);
  return hull;
}

constexpr std::size_t kNone = SIZE_MAX;

// The corner of the star from which its point's triangle with a and b goes on to the next corner.
std::size_t find_triangle(std::span<const StarCorner<LocalIndex>> star, LocalIndex a, LocalIndex b) {
  for (std::size_t i = 0; i < star.size(); ++i) {
    if (star[i].point != a) continue;
    const std::size_t next = i + 1 < star.size() ? i + 1 : 0, before = i > 0 ? i - 1 : star.size() - 1;
    if (star[next].point == b) return star[i].room <= 1 ? i : kNone;
    if (star[before].point == b) return star[before].room <= 1 ? before : kNone;
    return kNone;
  }
  return kNone;
}

// Of the corners whose stars are known, the first one asks the others.
void agree(Stars<LocalIndex>& stars, std::span<const std::uint8_t> is_border) {
  stars.agreements.resize(stars.corners.size(), Agreement::kRefused);
  for (LocalIndex p = 0; p < stars.size(); ++p) {
    const auto star = stars[p];
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (star[i].room > 1) continue;
      const LocalIndex a = star[i].point, b = star[i + 1 < star.size() ? i + 1 : 0].point;
      if ((a < p && !is_border[a]) || (b < p && !is_border[b])) continue;
      std::size_t in_a = kNone, in_b = kNone;
      if (!is_border[a] && (in_a = find_triangle(stars[a], p, b)) == kNone) continue;
      if (!is_border[b] && (in_b = find_triangle(stars[b], p, a)) == kNone) continue;
      const Agreement agreement = is_border[a] || is_border[b] ? Agreement::kOpen : Agreement::kAgreed;
      stars.agreements[stars.offsets[p] + i] = agreement;
      if (!is_border[a]) stars.agreements[stars.offsets[a] + in_a] = agreement;
      if (!is_border[b]) stars.agreements[stars.offsets[b] + in_b] = agreement;
    }
  }
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

std::vector<StarCorner<LocalIndex>> find_star_carefully(std::span<const Seat> seats, const StarQuery& query) {
  std::vector<StarCorner<LocalIndex>> star;
  if (!query.normal.allFinite()) return star;
  Views views = look_around(seats, query);
  if (views.all.size() < 3) return star;
  std::vector<View> hull = hull_of(std::move(views.all));
  if (hull.size() < 4) return star;
  hull.pop_back();
  const auto nearer = [](const View& a, const View& b) {
    const double squared_a = a.x * a.x + a.y * a.y, squared_b = b.x * b.x + b.y * b.y;
    return squared_a != squared_b ? squared_a < squared_b : a.neighbour > b.neighbour;
  };
  std::rotate(hull.begin(), std::max_element(hull.begin(), hull.end(), nearer), hull.end());
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const View &a = hull[i], &b = hull[i + 1 < hull.size() ? i + 1 : 0];
    star.push_back({a.neighbour, static_cast<float>(room_at(a.x, a.y, b.x - a.x, b.y - a.y, views.radius))});
  }
  return star;
}

void StarFinder::find(std::span<const StarQuery> queries) {
  StarBundle bundle{.seats = seats_.data()};
  for (std::size_t lane = 0; lane < kStarBundle; ++lane) {
    const StarQuery& query = queries[std::min(lane, queries.size() - 1)];
    const bool fits = lane < queries.size() && query.neighbours.size() <= kMostSeen;
    bundle.points[lane] = query.point;
    bundle.neighbours[lane] = query.neighbours.data();
    bundle.counts[lane] = fits ? static_cast<std::uint32_t>(query.neighbours.size()) : 0;
    for (int axis = 0; axis < 3; ++axis) bundle.normals[axis][lane] = query.normal[axis];
  }
  fastest::find_bundled_stars(bundle, bundled_);

  corners_.clear();
  for (std::size_t lane = 0; lane < queries.size(); ++lane) {
    const std::uint32_t size = bundled_.sizes[lane];
    if (queries[lane].neighbours.size() > kMostSeen || size == BundledStars::kInDoubt) {
      const auto star = find_star_carefully(seats_, queries[lane]);
      corners_.insert(corners_.end(), star.begin(), star.end());
    } else {
      for (std::size_t i = 0; i < size; ++i) corners_.push_back(bundled_.corners[i][lane]);
    }
    ends_[lane + 1] = corners_.size();
  }
}

Stars<LocalIndex> find_stars(const TilePoints& points, const Rows& neighbourhoods,
                             std::span<const Evaluation> evaluations, std::span<const Seat> seats,
                             std::span<const std::uint8_t> is_border) {
  Stars<LocalIndex> stars;
  stars.offsets.reserve(points.owned + 1);
  stars.corners.reserve(std::size_t{8} * points.owned);
  StarFinder finder(seats);
  std::vector<StarQuery> queries;
  for (LocalIndex first = 0; first < points.owned; first += kStarBundle) {
    const LocalIndex end = std::min<LocalIndex>(first + kStarBundle, points.owned);
    queries.clear();
    for (LocalIndex p = first; p < end; ++p) {
      queries.push_back(
          {p, evaluations[p].normal, is_border[p] ? std::span<const LocalIndex>() : neighbourhoods[p]});
    }
    finder.find(queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      for (const auto& corner : finder[i])
        stars.corners.push_back({queries[i].neighbours[corner.point], corner.room});
      stars.offsets.push_back(static_cast<std::uint32_t>(stars.corners.size()));
    }
  }
  agree(stars, is_border);
  return stars;
}

}  // namespace lacuna
