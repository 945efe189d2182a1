// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/stars.hpp"

#include "engine/boundary/tangential/star-inl.hpp"
#include "engine/model/mixed.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lacuna::tangential {
namespace {

// The unit is r^2: far above rounding, far below the precision of a scanner.
constexpr double kWeights = 1e-5;

// Returns a number in [0, 1) that looks random. It is one of the place, so it does not change with the order of
// the points.
double random_share(const Eigen::Vector3d& place) {
  std::uint64_t hash = 0;
  for (const double coordinate : place)
    hash = mixed(hash ^ std::bit_cast<std::uint64_t>(coordinate + 0.));  // -0 is 0
  return static_cast<double>(hash >> 11) * 0x1p-53;
}

// These are the kernel's formulas, for one point.
namespace formulas = HWY_NAMESPACE;
using One = formulas::hn::Vec<formulas::hn::CappedTag<double, 1>>;

One one(double number) {
  return formulas::all<One>(number);
}
template <class Components>
formulas::Vector<One> vector(const Components& components) {
  return {one(components[0]), one(components[1]), one(components[2])};
}
template <class V>
auto number(V one) {
  return formulas::hn::GetLane(one);
}

// A neighbour in the tangent plane, inverted.
struct View {
  double x, y;
  LocalIndex neighbour;
};

struct Views {
  std::vector<View> all;
  double distance;  // `Sampling::distance`
};

Views find_views(std::span<const Site> sites, const StarQuery& query) {
  const Site& at = sites[query.point];
  const auto frame = formulas::frame_of(vector(query.normal));
  Views views;
  double sum = at.closeness;
  for (LocalIndex i = 0; i < query.neighbours.size(); ++i) {
    const Site& q = sites[query.neighbours[i]];
    sum += q.closeness;
    const auto offset = (vector(q.position) - vector(at.position)) + (vector(q.shift) - vector(at.shift));
    const auto inverted = formulas::view_of(offset, one(at.weight - q.weight), frame);
    const View view{number(inverted.x), number(inverted.y), i};
    if (std::isfinite(view.x) && std::isfinite(view.y)) views.all.push_back(view);
  }
  views.distance = static_cast<double>(query.neighbours.size() + 1) / sum;
  return views;
}

// Returns the convex hull, by Andrew's monotone chain. Its last point is the first again.
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

Site site_of(const Eigen::Vector3d& position, const Evaluation& evaluation) {
  const double r = evaluation.mean_distance;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  if (evaluation.normal.allFinite())
    shift = evaluation.normal * evaluation.normal.dot(evaluation.mean_offset);
  return {{position.x(), position.y(), position.z()},
          {shift.x(), shift.y(), shift.z()},
          1 / r,
          kWeights * random_share(position) * r * r};
}

ExactStar find_star_exactly(std::span<const Site> sites, const StarQuery& query) {
  ExactStar star;
  if (!query.normal.allFinite()) return star;
  Views views = find_views(sites, query);
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
    const auto radius = formulas::radius_at(one(x), one(y), one(dx), one(dy), one(views.distance));
    star.link.push_back({hull[i].neighbour, number(radius)});
    x += dx;  // rounded as in a batch
    y += dy;
  }
  return star;
}

void StarFinder::find() {
  StarBatch batch{.sites = sites_.data()};
  for (std::size_t lane = 0; lane < kBatchSize; ++lane) {
    const StarQuery& query = queries_[std::min(lane, queries_.size() - 1)];
    const bool fits = lane < queries_.size() && query.neighbours.size() <= kMostNeighbours;
    batch.points[lane] = query.point;
    batch.neighbours[lane] = query.neighbours.empty() ? &query.point : query.neighbours.data();
    batch.counts[lane] = fits ? static_cast<std::uint32_t>(query.neighbours.size()) : 0;
    for (int axis = 0; axis < 3; ++axis) batch.normals[axis][lane] = query.normal[axis];
  }
  find_batch_stars(batch, batch_stars_);

  for (std::size_t lane = 0; lane < queries_.size(); ++lane) {
    const std::uint32_t size = batch_stars_.sizes[lane];
    if (queries_[lane].neighbours.size() > kMostNeighbours || size == BatchStars::kAmbiguous) {
      exact_[lane] = find_star_exactly(sites_, queries_[lane]);
      stars_[lane] = {exact_[lane].link.data(), 1, exact_[lane].link.size(), exact_[lane].distance};
    } else {
      stars_[lane] = {&batch_stars_.links[0][lane], kBatchSize, size, batch_stars_.distances[lane]};
    }
  }
}

}  // namespace lacuna::tangential
