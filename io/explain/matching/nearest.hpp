// SPDX-License-Identifier: Apache-2.0
// Finds the line segments and the points that are near a place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lacuna::matching {

// A segment is between two places; a point is a segment from itself to itself.
struct Segment {
  Eigen::Vector3d a, b;
  std::size_t owner = 0;  // what it is part of
};

double distance_to(const Segment& segment, const Eigen::Vector3d& point);

// A tree of boxes over segments of any length, halved at the median of their middles. Building it costs n log
// n; a query costs log n if few segments are near.
class EdgeTree {
 public:
  // Segments with an end that is not finite are near nothing.
  explicit EdgeTree(std::vector<Segment> segments);

  // Finds the owners of the segments at most `radius` from the point, each once, ascending. Finds none
  // for a point that is not finite.
  void owners_within(const Eigen::Vector3d& point, double radius, std::vector<std::size_t>& owners) const;

 private:
  // Segments [first, last), in two halves at their middle unless they are few.
  void build(std::size_t node, std::size_t first, std::size_t last);
  void look(std::size_t node, std::size_t first, std::size_t last, const Eigen::Vector3d& point,
            double radius, std::vector<std::size_t>& owners) const;

  std::vector<Segment> segments_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // of node i; its halves are 2 i + 1 and 2 i + 2
};

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
