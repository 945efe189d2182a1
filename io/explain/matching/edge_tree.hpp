// SPDX-License-Identifier: Apache-2.0
// Finds the line segments near a point.
#pragma once

#include <cstddef>
#include <vector>

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

}  // namespace lacuna::matching
