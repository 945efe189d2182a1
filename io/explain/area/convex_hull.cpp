// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/convex_hull.hpp"

#include <algorithm>
#include <utility>

namespace lacuna::io {
namespace {

bool is_left_turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) > (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

// Andrew's monotone chain: the lower chain from west to east, then the upper one back.
void ConvexHull::reduce() {
  const auto is_before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  };
  std::sort(points_.begin(), points_.end(), is_before);
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
  Ring2 hull;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (auto point = begin; point != end; ++point) {
      while (hull.size() >= first + 2 && !is_left_turn(hull[hull.size() - 2], hull.back(), *point))
        hull.pop_back();
      hull.push_back(*point);
    }
    hull.pop_back();  // the first of the other chain
  };
  if (points_.size() > 2) {
    add_chain(points_.begin(), points_.end());
    add_chain(points_.rbegin(), points_.rend());
    points_ = std::move(hull);
  }
  kept_ = points_.size();
}

}  // namespace lacuna::io
