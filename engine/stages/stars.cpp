#include "engine/stages/stars.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna {
namespace {

// In units of r^2: far above rounding, far below what a scanner can tell.
constexpr double kWeights = 1e-4;

// A number in [0, 1) that looks random.
double random_share(PointId id) {
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
  double distance;  // `Sampling::distance`
};

Views look_around(std::span<const Seat> seats, const StarQuery& query) {
  const Seat& at = seats[query.point];
  const Frame<double> frame = frame_of(Vector<double>{query.normal.x(), query.normal.y(), query.normal.z()});
  Views views;
  double sum = at.closeness;
  for (LocalIndex i = 0; i < query.neighbours.size(); ++i) {
    const Seat& q = seats[query.neighbours[i]];
    sum += q.closeness;
    const Vector<double> d =
        (vector(q.position) - vector(at.position)) + (vector(q.shift) - vector(at.shift));
    // The weights make it a ball orthogonal to small balls around the points: any two views of four points
    // on one circle then agree on how it falls into triangles.
    const double power = dot(d, d) + (at.weight - q.weight);
    const double inverse = 1 / power;
    const View view{dot(d, frame.u) * inverse, dot(d, frame.v) * inverse, i};
    if (power > 0 && std::isfinite(view.x) && std::isfinite(view.y)) views.all.push_back(view);
  }
  views.distance = static_cast<double>(query.neighbours.size() + 1) / sum;
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

}  // namespace

Seat seat_of(const Eigen::Vector3d& position, PointId id, const Evaluation& evaluation) {
  const double r = evaluation.mean_distance;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  if (evaluation.normal.allFinite())
    shift = evaluation.normal * evaluation.normal.dot(evaluation.mean_offset);
  return {{position.x(), position.y(), position.z()},
          {shift.x(), shift.y(), shift.z()},
          1 / r,
          kWeights * random_share(id) * r * r};
}

CarefulStar find_star_carefully(std::span<const Seat> seats, const StarQuery& query) {
  CarefulStar star;
  if (!query.normal.allFinite()) return star;
  Views views = look_around(seats, query);
  star.distance = views.distance;
  if (views.all.size() < 3) return star;
  std::vector<View> hull = hull_of(std::move(views.all));
  if (hull.size() < 4) return star;
  hull.pop_back();
  const auto nearer = [](const View& a, const View& b) {
    const double squared_a = a.x * a.x + a.y * a.y, squared_b = b.x * b.x + b.y * b.y;
    return squared_a != squared_b ? squared_a < squared_b : a.neighbour > b.neighbour;
  };
  std::rotate(hull.begin(), std::max_element(hull.begin(), hull.end(), nearer), hull.end());
  double x = hull[0].x, y = hull[0].y;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const View& next = hull[i + 1 < hull.size() ? i + 1 : 0];
    const double dx = next.x - x, dy = next.y - y;
    star.corners.push_back({hull[i].neighbour, ball_at(x, y, dx, dy, views.distance)});
    x += dx;  // rounded as in a bundle
    y += dy;
  }
  return star;
}

void StarFinder::find() {
  StarBundle bundle{.seats = seats_.data()};
  for (std::size_t lane = 0; lane < kStarBundle; ++lane) {
    const StarQuery& query = queries_[std::min(lane, queries_.size() - 1)];
    const bool fits = lane < queries_.size() && query.neighbours.size() <= kMostSeen;
    bundle.points[lane] = query.point;
    bundle.neighbours[lane] = query.neighbours.empty() ? &query.point : query.neighbours.data();
    bundle.counts[lane] = fits ? static_cast<std::uint32_t>(query.neighbours.size()) : 0;
    for (int axis = 0; axis < 3; ++axis) bundle.normals[axis][lane] = query.normal[axis];
  }
  fastest::find_bundled_stars(bundle, bundled_);

  for (std::size_t lane = 0; lane < queries_.size(); ++lane) {
    const std::uint32_t size = bundled_.sizes[lane];
    if (queries_[lane].neighbours.size() > kMostSeen || size == BundledStars::kInDoubt) {
      careful_[lane] = find_star_carefully(seats_, queries_[lane]);
      stars_[lane] = {careful_[lane].corners.data(), 1, careful_[lane].corners.size(),
                      careful_[lane].distance};
    } else {
      stars_[lane] = {&bundled_.corners[0][lane], kStarBundle, size, bundled_.distances[lane]};
    }
  }
}

}  // namespace lacuna
