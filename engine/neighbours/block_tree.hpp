// SPDX-License-Identifier: Apache-2.0
// A tree over points in store order: its leaves are blocks of sixteen consecutive points. Points
// near in the order are near in space, so the tree needs no building beyond its boxes.
#pragma once

#include "engine/neighbours/candidate_list.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// Empty: its low side is infinite.
struct BlockBox {
  static constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{kInfinite, kInfinite, kInfinite};
  std::array<double, 3> high{-kInfinite, -kInfinite, -kInfinite};

  void extend(const Eigen::Vector3d& p) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
};

// Memory: 28 bytes a point.
class BlockTree {
 public:
  BlockTree(const BlockTree&) = delete;
  BlockTree& operator=(const BlockTree&) = delete;
  explicit BlockTree(std::span<const Eigen::Vector3d> positions);

  // Sets `surroundings.blocks` to all blocks within the radius of a box. Returns false where they are more
  // than kMostBlocks.
  bool find_near(const BlockBox& box, double squared_radius, Surroundings& surroundings) const;

  // Fills the boxes and coordinates of the blocks in `surroundings.blocks`.
  void fill_surroundings(Surroundings& surroundings) const;

  // Calls visit(first, last) for the points of each block whose squared distance is at most bound(), mostly
  // the nearest block first. The bound may shrink on the way.
  template <class Bound, class Visit>
  void walk(const Eigen::Vector3d& from, Bound&& bound, Visit&& visit) const {
    walk(from, levels_.size() - 1, 0, bound, visit);
  }

 private:
  // Boxes of one level, one array per side, padded to whole groups with empty boxes.
  struct Level {
    std::size_t count;
    std::array<std::vector<double>, 3> low, high;

    explicit Level(std::size_t count);
    void set(std::size_t index, const BlockBox& box);
  };

  template <class Bound, class Visit>
  void walk(const Eigen::Vector3d& from, std::size_t level, std::size_t group, Bound& bound,
            Visit& visit) const {
    std::array<double, kFan> gaps;
    box_gaps(from.data(), from.data(), sides_[level], group, gaps.data());
    std::array<std::size_t, kFan> order;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gaps[a] < gaps[b]; });
    for (const std::size_t i : order) {
      const std::size_t index = group * kFan + i;
      if (index >= levels_[level].count) continue;
      if (gaps[i] > bound()) return;
      if (level > 0) {
        walk(from, level - 1, index, bound, visit);
      } else {
        visit(index * kBlock, std::min((index + 1) * kBlock, points_));
      }
    }
  }

  std::size_t points_;
  std::vector<Block> blocks_;
  std::vector<Level> levels_;
  std::vector<LevelSides> sides_;  // of the levels: places in their memory
};

}  // namespace lacuna
