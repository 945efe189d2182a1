// SPDX-License-Identifier: Apache-2.0
// Exact nearest neighbours in the order of the method (4.1) by a nanoflann kd-tree. It is a second opinion on
// the search in blocks, for more points than brute force allows.
#pragma once

#include "engine/model/neighbourhoods.hpp"

#include <memory>
#include <span>
#include <vector>

namespace lacuna {

// A tree over distinct points, which must outlive it. Queries may come from several threads.
class PointTree {
 public:
  PointTree(std::span<const Eigen::Vector3d> positions, std::span<const PointId> ids);
  ~PointTree();

  // The first k points in neighbour order around point `query`, itself excluded; all where fewer exist.
  void nearest(LocalIndex query, std::size_t k, std::vector<Neighbour>& found) const;

  // Every point with squared distance <= `squared_radius`, `query` excluded, in neighbour order.
  void within(LocalIndex query, double squared_radius, std::vector<Neighbour>& found) const;

 private:
  struct Index;
  std::span<const Eigen::Vector3d> positions_;
  std::span<const PointId> ids_;
  std::unique_ptr<Index> index_;
};

// The first k points in neighbour order around point `query`, by a look at each.
std::vector<Neighbour> nearest_plainly(std::span<const Eigen::Vector3d> positions,
                                       std::span<const PointId> ids, LocalIndex query, std::size_t k);

}  // namespace lacuna
