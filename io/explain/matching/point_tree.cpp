// SPDX-License-Identifier: Apache-2.0
#include "io/explain/matching/point_tree.hpp"

#include "io/explain/matching/nanoflann_tree.hpp"

#include <cmath>
#include <limits>

namespace lacuna::matching {

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
