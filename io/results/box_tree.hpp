// SPDX-License-Identifier: Apache-2.0
// Finds the boxes, among many, that a point lies in.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna::io {

// A balanced tree of boxes, halved at the median of their centres. Memory: less than 200 bytes a box. The
// cost of a point is logarithmic in the number of boxes if they do not overlap. It is linear in the number of
// boxes that hold the point.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Eigen::AlignedBox3d> boxes);

  // Calls visit(index) for each box that has the point, borders included, in an order of the tree. A point
  // that is not finite lies in none.
  template <class Visit>
  void for_each_around(const Eigen::Vector3d& point, const Visit& visit) const {
    for (std::size_t at = 0; at < nodes_.size();) {
      const Node& node = nodes_[at];
      if (!node.box.contains(point)) {
        at = node.next;
        continue;
      }
      for (const std::size_t box : std::span(order_).subspan(node.first, node.count)) {
        if (boxes_[box].contains(point)) visit(box);
      }
      ++at;
    }
  }

 private:
  // A node comes before the nodes below it.
  struct Node {
    Eigen::AlignedBox3d box;
    std::size_t next = 0;              // behind all nodes below it
    std::size_t first = 0, count = 0;  // in order_; 0 unless it is a leaf
  };
  void add(std::size_t first, std::size_t end);

  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace lacuna::io
