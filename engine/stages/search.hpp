// search: exact nearest neighbours in the order of the method (4.1), by a nanoflann kd-tree.
#pragma once

#include "engine/data/neighbourhoods.hpp"

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
  // Throws `Error` if the squared distance to another point underflows.
  void nearest(LocalIndex query, std::size_t k, std::vector<Neighbour>& found) const;

  // Every point with squared distance <= `squared_radius`, `query` excluded, in neighbour order.
  void within(LocalIndex query, double squared_radius, std::vector<Neighbour>& found) const;

 private:
  struct Index;
  std::span<const Eigen::Vector3d> positions_;
  std::span<const PointId> ids_;
  std::unique_ptr<Index> index_;
};

// Throws `Error` where two distinct points are so near that their squared distance loses digits.
void refuse_underflow(double squared_distance, PointId a, PointId b);

}  // namespace lacuna
