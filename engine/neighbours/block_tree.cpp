// SPDX-License-Identifier: Apache-2.0
#include "engine/neighbours/block_tree.hpp"

namespace lacuna {

BlockTree::Level::Level(std::size_t boxes) : count(boxes) {
  const std::size_t padded = (count + kFan - 1) / kFan * kFan;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis].assign(padded, BlockBox::kInfinite);
    high[axis].assign(padded, -BlockBox::kInfinite);
  }
}

void BlockTree::Level::set(std::size_t index, const BlockBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    low[axis][index] = box.low[axis];
    high[axis][index] = box.high[axis];
  }
}

BlockTree::BlockTree(std::span<const Eigen::Vector3d> positions)
    : points_(positions.size()), blocks_((positions.size() + kBlock - 1) / kBlock) {
  levels_.emplace_back(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    BlockBox box;
    const std::size_t end = std::min((b + 1) * kBlock, points_);
    if (end < (b + 1) * kBlock) std::fill_n(blocks_[b].coordinates[0], 3 * kBlock, BlockBox::kInfinite);
    for (std::size_t i = b * kBlock; i < end; ++i) {
      box.extend(positions[i]);
      for (int axis = 0; axis < 3; ++axis) blocks_[b].coordinates[axis][i % kBlock] = positions[i][axis];
    }
    levels_[0].set(b, box);
  }
  while (levels_.back().count > kFan) {
    const Level& below = levels_.back();
    Level level((below.count + kFan - 1) / kFan);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < level.count; ++i) {
        const auto low = below.low[axis].begin() + static_cast<std::ptrdiff_t>(i * kFan);
        const auto high = below.high[axis].begin() + static_cast<std::ptrdiff_t>(i * kFan);
        level.low[axis][i] = *std::min_element(low, low + kFan);
        level.high[axis][i] = *std::max_element(high, high + kFan);
      }
    }
    levels_.push_back(std::move(level));
  }
  for (const Level& level : levels_) {
    LevelSides& sides = sides_.emplace_back(LevelSides{.count = level.count});
    for (int axis = 0; axis < 3; ++axis) {
      sides.lows[axis] = level.low[axis].data();
      sides.highs[axis] = level.high[axis].data();
    }
  }
}

bool BlockTree::find_near(const BlockBox& box, double squared_radius, Surroundings& surroundings) const {
  return find_blocks(sides_.data(), sides_.size() - 1, box.low.data(), box.high.data(), squared_radius,
                     surroundings);
}

void BlockTree::fill_surroundings(Surroundings& surroundings) const {
  lacuna::fill_surroundings(blocks_.data(), sides_[0].lows, sides_[0].highs, surroundings);
}

}  // namespace lacuna
