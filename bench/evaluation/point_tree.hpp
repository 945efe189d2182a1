// SPDX-License-Identifier: Apache-2.0
// Which points are nearest to a place.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::evaluation {

// A tree over points of the caller's, which are finite. Built in n log n; an answer costs log n.
class PointTree {
 public:
  explicit PointTree(std::span<const Eigen::Vector3d> points);
  ~PointTree();

  // By distance, those to the nearest `count` points, or to all where there are fewer. Squares of distances
  // too large for a double leave a point out.
  std::vector<double> nearest_distances(const Eigen::Vector3d& place, std::size_t count) const;

  // Those points themselves, as places in the span.
  std::vector<std::size_t> nearest_points(const Eigen::Vector3d& place, std::size_t count) const;

  // Infinite where there is none.
  double nearest_distance(const Eigen::Vector3d& place) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace lacuna::evaluation
