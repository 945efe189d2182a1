// SPDX-License-Identifier: Apache-2.0
#include "io/results/box_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lacuna::io {

BoxTree::BoxTree(std::vector<Eigen::AlignedBox3d> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  if (!boxes_.empty()) add(0, boxes_.size());
}

void BoxTree::add(std::size_t first, std::size_t end) {
  constexpr std::size_t kLeaf = 4;
  const std::size_t at = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d all, centres;
  for (std::size_t i = first; i < end; ++i) {
    all.extend(boxes_[order_[i]]);
    centres.extend(boxes_[order_[i]].center());
  }
  nodes_[at].box = all;
  if (end - first <= kLeaf) {
    nodes_[at].first = first;
    nodes_[at].count = end - first;
  } else {
    Eigen::Index axis = 0;
    centres.sizes().maxCoeff(&axis);
    const std::size_t middle = first + (end - first) / 2;
    const auto place = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(place(first), place(middle), place(end), [&](std::size_t a, std::size_t b) {
      const double left = boxes_[a].center()[axis], right = boxes_[b].center()[axis];
      return std::pair(left, a) < std::pair(right, b);
    });
    add(first, middle);
    add(middle, end);
  }
  nodes_[at].next = nodes_.size();
}

}  // namespace lacuna::io
