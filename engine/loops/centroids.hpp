// SPDX-License-Identifier: Apache-2.0
// Loops by their centroids.
#pragma once

#include "engine/model/loop.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {

// Sorts them along the axis on which they extend the farthest. The loops must outlive it.
class Centroids {
 public:
  explicit Centroids(const std::vector<LoopMeasures>& loops) : loops_(loops), order_(loops.size()) {
    Eigen::AlignedBox3d box;
    for (const LoopMeasures& loop : loops) box.extend(loop.centroid);
    if (!loops.empty()) box.sizes().maxCoeff(&axis_);
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(along(a), a) < std::pair(along(b), b); });
  }

  // Calls visit(loop) for each loop whose centroid is within `radius` of the place.
  template <class Visit>
  void for_each_near(const Eigen::Vector3d& place, double radius, Visit&& visit) const {
    auto next = std::lower_bound(order_.begin(), order_.end(), place[axis_] - radius,
                                 [&](std::size_t loop, double least) { return along(loop) < least; });
    for (; next != order_.end() && along(*next) <= place[axis_] + radius; ++next) {
      if ((loops_[*next].centroid - place).norm() <= radius) visit(*next);
    }
  }

 private:
  double along(std::size_t loop) const { return loops_[loop].centroid[axis_]; }

  const std::vector<LoopMeasures>& loops_;
  std::vector<std::size_t> order_;
  Eigen::Index axis_ = 0;
};

}  // namespace lacuna
