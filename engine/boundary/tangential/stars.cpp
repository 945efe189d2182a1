// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/tangential/stars.hpp"

#include "engine/boundary/tangential/star-inl.hpp"
#include "engine/model/mixed.hpp"
#include "engine/simd/sort.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lacuna::tangential {
namespace {

// The unit is r^2: far above rounding, far below the precision of a scanner.
constexpr double kWeights = 1e-5;

// Returns a number in [0, 1) that looks random. It is one of the place, so it does not change with the order
// of the points.
double random_share(const Eigen::Vector3d& place) {
  std::uint64_t hash = 0;
  for (const double coordinate : place)
    hash = mixed(hash ^ std::bit_cast<std::uint64_t>(coordinate + 0.));  // -0 is 0
  return static_cast<double>(hash >> 11) * 0x1p-53;
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

namespace {

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

namespace {

// Pads the lanes that have fewer numbers than others: it sorts behind all of them.
constexpr Batch<double> kBeyondAll = [] {
  Batch<double> batch{};
  for (double& number : batch.at) number = std::numeric_limits<double>::infinity();
  return batch;
}();

using Counts = std::array<std::size_t, kBatchSize>;

}  // namespace

std::array<Sampling, kBatchSize> samplings_of(std::span<const FoundStar> stars,
                                              const TangentialConfig& config) {
  // One lane for each star, one element for each of its triangles. Few stars have more than 16.
  std::size_t most = 0;
  for (const FoundStar& star : stars) most = std::max(most, star.size());
  std::vector<Batch<double>> many;
  std::array<Batch<double>, 16> few;
  if (most > few.size()) many.resize(most);
  const std::span<Batch<double>> radii(many.empty() ? few.data() : many.data(), most);
  std::fill(radii.begin(), radii.end(), kBeyondAll);
  // Take the circumradii that are not of holes.
  Counts counts{};
  for (std::size_t i = 0; i < stars.size(); ++i) {
    for (std::size_t vertex = 0; vertex < stars[i].size(); ++vertex) {
      const double radius = stars[i][vertex].radius;
      radii[counts[i]].at[i] = radius <= config.hole_radius ? radius : kBeyondAll.at[i];
      counts[i] += radius <= config.hole_radius;
    }
  }
  sort_batches(radii.data(), *std::max_element(counts.begin(), counts.end()));
  // Radii are in mean distances, samplings are lengths.
  std::array<Sampling, kBatchSize> samplings{};
  for (std::size_t i = 0; i < stars.size(); ++i) {
    if (stars[i].size() == 0) continue;
    samplings[i].distance = stars[i].distance();
    if (counts[i] == 0) continue;
    const double median = radii[counts[i] / 2].at[i];
    samplings[i].median_radius = median * samplings[i].distance;
    samplings[i].spread = (median - radii[0].at[i]) * samplings[i].distance;
  }
  return samplings;
}

void RadiusBounder::find() {
  std::size_t most = 0;
  for (const PointAndNeighbours& p : points_) most = std::max(most, p.neighbours.size() + 1);
  if (medians_.size() < most) {
    medians_.resize(most);
    spreads_.resize(most);
  }
  std::fill_n(medians_.begin(), most, kBeyondAll);
  std::fill_n(spreads_.begin(), most, kBeyondAll);
  // One lane for each point: the numbers of the point and of its neighbours that have any.
  Counts counts{};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto add = [&](LocalIndex q) {
      const Sampling& sampling = samplings_[q];
      medians_[counts[i]].at[i] = sampling.median_radius > 0 ? sampling.median_radius : kBeyondAll.at[i];
      spreads_[counts[i]].at[i] = sampling.median_radius > 0 ? sampling.spread : kBeyondAll.at[i];
      counts[i] += sampling.median_radius > 0;
    };
    add(points_[i].point);
    for (const LocalIndex q : points_[i].neighbours) add(q);
  }
  most = *std::max_element(counts.begin(), counts.end());
  sort_batches(medians_.data(), most);
  sort_batches(spreads_.data(), most);
  // M and S are the medians, limited to a share of the mean distance (method.md, C.2).
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double distance = samplings_[points_[i].point].distance;
    bounds_[i] = {};
    if (distance == 0) continue;
    const double most = config_.most_radius * distance;
    const double median_radius = std::min(medians_[counts[i] / 2].at[i], most);
    const double spread = std::min(spreads_[counts[i] / 2].at[i], most);
    const double fine = (config_.max_radius * median_radius + spread) / distance;
    bounds_[i] = {static_cast<float>(fine), static_cast<float>(config_.coarse_bound * fine)};
  }
}

void RadiiAround::add(const ScaledRadii& radii) {
  for (const float radius : radii.star.radii) {
    if (radius > std::numeric_limits<float>::max()) break;  // the others are infinite, too
    radii_.push_back(radius * radii.distance);
  }
}

double RadiiAround::sampling_radius(double bound) const {
  std::array<std::uint32_t, kSteps + 1> counts{};  // by how many steps they exceed; the last: not within
  const double per_step = kSteps / bound;
  for (const double radius : radii_)
    ++counts[static_cast<std::size_t>(std::min(radius * per_step, double{kSteps}))];
  const std::size_t count = radii_.size() - counts[kSteps], rank = count * 9 / 10;
  if (count == 0) return bound;
  std::size_t step = 0;
  for (std::size_t below = counts[0]; below <= rank; below += counts[step]) ++step;
  return static_cast<double>(step + 1) / kSteps * bound;
}

}  // namespace lacuna::tangential
