// SPDX-License-Identifier: Apache-2.0
// Finds the points that are nearest to a place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna::matching {

// A tree over the caller's points, which are finite. Building it costs n log n; a query costs log n.
class PointTree {
 public:
  explicit PointTree(std::span<const Eigen::Vector3d> points);
  ~PointTree();

  // Returns the squared distances to the nearest `count` points, or to all if there are fewer, in ascending
  // order. A point is left out if the square of its distance is too large for a double.
  std::vector<double> nearest_distances(const Eigen::Vector3d& place, std::size_t count) const;

  // Returns these points themselves, as places in the span.
  std::vector<std::size_t> nearest_points(const Eigen::Vector3d& place, std::size_t count) const;

  // Returns infinity if there is no point.
  double nearest_distance(const Eigen::Vector3d& place) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

// Returns the finite points, each place once.
std::vector<Eigen::Vector3d> distinct_points(std::span<const Eigen::Vector3d> positions,
                                             std::span<const std::uint64_t> stand_ins);

}  // namespace lacuna::matching
