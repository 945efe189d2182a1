// SPDX-License-Identifier: Apache-2.0
#include "io/explain/matching/nearest.hpp"

#include "engine/model/nanoflann_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lacuna::matching {
namespace {

constexpr std::size_t kLeaf = 8;

bool is_finite(const Segment& segment) {
  return segment.a.allFinite() && segment.b.allFinite();
}

}  // namespace

double distance_to(const Segment& segment, const Eigen::Vector3d& point) {
  const Eigen::Vector3d along = segment.b - segment.a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((point - segment.a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (point - (segment.a + t * along)).norm();
}

EdgeTree::EdgeTree(std::vector<Segment> segments) : segments_(std::move(segments)) {
  std::erase_if(segments_, [](const Segment& segment) { return !is_finite(segment); });
  if (!segments_.empty()) build(0, 0, segments_.size());
}

void EdgeTree::build(std::size_t node, std::size_t first, std::size_t last) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = first; i < last; ++i) box.extend(segments_[i].a).extend(segments_[i].b);
  if (boxes_.size() <= node) boxes_.resize(node + 1);
  boxes_[node] = box;
  if (last - first <= kLeaf) return;
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t i) { return segments_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [axis](const Segment& x, const Segment& y) {
    return x.a[axis] + x.b[axis] < y.a[axis] + y.b[axis];
  });
  build(2 * node + 1, first, middle);
  build(2 * node + 2, middle, last);
}

void EdgeTree::owners_within(const Eigen::Vector3d& point, double radius,
                             std::vector<std::size_t>& owners) const {
  owners.clear();
  if (segments_.empty() || !point.allFinite()) return;
  look(0, 0, segments_.size(), point, radius, owners);
  std::sort(owners.begin(), owners.end());
  owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
}

void EdgeTree::look(std::size_t node, std::size_t first, std::size_t last, const Eigen::Vector3d& point,
                    double radius, std::vector<std::size_t>& owners) const {
  if (boxes_[node].exteriorDistance(point) > radius) return;
  if (last - first > kLeaf) {
    const std::size_t middle = first + (last - first) / 2;
    look(2 * node + 1, first, middle, point, radius, owners);
    look(2 * node + 2, middle, last, point, radius, owners);
    return;
  }
  for (std::size_t i = first; i < last; ++i) {
    if (distance_to(segments_[i], point) <= radius) owners.push_back(segments_[i].owner);
  }
}

struct PointTree::Tree : NanoflannTree<std::size_t> {
  using NanoflannTree::NanoflannTree;
};

PointTree::PointTree(std::span<const Eigen::Vector3d> points) : tree_(std::make_unique<Tree>(points)) {}
PointTree::~PointTree() = default;

std::vector<double> PointTree::nearest_distances(const Eigen::Vector3d& place, std::size_t count) const {
  std::vector<std::size_t> points(count);
  std::vector<double> distances(count);
  distances.resize(tree_->index.knnSearch(place.data(), count, points.data(), distances.data()));
  for (double& distance : distances) distance = std::sqrt(distance);
  return distances;
}

std::vector<std::size_t> PointTree::nearest_points(const Eigen::Vector3d& place, std::size_t count) const {
  std::vector<std::size_t> points(count);
  std::vector<double> squares(count);
  points.resize(tree_->index.knnSearch(place.data(), count, points.data(), squares.data()));
  return points;
}

double PointTree::nearest_distance(const Eigen::Vector3d& place) const {
  std::size_t point = 0;
  double square = 0;
  const bool found = tree_->index.knnSearch(place.data(), 1, &point, &square) > 0;
  return found ? std::sqrt(square) : std::numeric_limits<double>::infinity();
}

std::vector<Eigen::Vector3d> distinct_points(std::span<const Eigen::Vector3d> positions,
                                             std::span<const std::uint64_t> stand_ins) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t id = 0; id < positions.size(); ++id) {
    if (stand_ins[id] == id && positions[id].allFinite()) points.push_back(positions[id]);
  }
  return points;
}

}  // namespace lacuna::matching
