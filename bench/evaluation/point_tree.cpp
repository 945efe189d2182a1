// SPDX-License-Identifier: Apache-2.0
#include "bench/evaluation/point_tree.hpp"

#include <cmath>
#include <limits>

#include <nanoflann.hpp>

namespace lacuna::evaluation {
namespace {

struct Adaptor {
  std::span<const Eigen::Vector3d> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t point, std::size_t axis) const { return points[point][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Metric = nanoflann::L2_Simple_Adaptor<double, Adaptor, double, std::size_t>;
using Index = nanoflann::KDTreeSingleIndexAdaptor<Metric, Adaptor, 3, std::size_t>;

}  // namespace

struct PointTree::Tree {
  Adaptor adaptor;
  Index index{3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(12)};
};

PointTree::PointTree(std::span<const Eigen::Vector3d> points) : tree_(new Tree{.adaptor = {points}}) {}
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

}  // namespace lacuna::evaluation
