#include "engine/neighbours/block_tree.hpp"

namespace lacuna {

BlockTree::Level::Level(std::size_t boxes) : count(boxes) {
  const std::size_t padded = (count + kFan - 1) / kFan * kFan;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis].assign(padded, BlockBox::kInfinite);
    high[axis].assign(padded, -BlockBox::kInfinite);
  }
}

BlockTree::Level::Sides BlockTree::Level::sides(std::size_t group) const {
  Sides sides{};
  for (int axis = 0; axis < 3; ++axis) {
    sides.lows[axis] = low[axis].data() + group * kFan;
    sides.highs[axis] = high[axis].data() + group * kFan;
  }
  return sides;
}

void BlockTree::Level::set(std::size_t index, const BlockBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    low[axis][index] = box.low[axis];
    high[axis][index] = box.high[axis];
  }
}

std::uint32_t BlockTree::Level::within(std::size_t group, const BlockBox& from, double squared_radius) const {
  const Sides to = sides(group);
  const std::size_t there =
      std::min(kFan, count - group * kFan);  // where distances overflow, so does padding
  return boxes_within(from.low.data(), from.high.data(), to.lows, to.highs, squared_radius) &
         ((1U << there) - 1);
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
}

bool BlockTree::find_near(const BlockBox& box, double squared_radius, Surroundings& surroundings) const {
  struct Place {
    std::size_t level, group;
  };
  std::array<Place, 128> stack;
  std::size_t depth = 0;
  stack[depth++] = {levels_.size() - 1, 0};
  surroundings.count = 0;
  while (depth > 0) {
    const auto [level, group] = stack[--depth];
    for (std::uint32_t within = levels_[level].within(group, box, squared_radius); within != 0;
         within &= within - 1) {
      const std::size_t index = group * kFan + static_cast<std::size_t>(std::countr_zero(within));
      if (level > 0) {
        stack[depth++] = {level - 1, index};
        continue;
      }
      if (surroundings.count == kMostBlocks) return false;
      surroundings.blocks[surroundings.count++] = static_cast<std::uint32_t>(index);
    }
  }
  return true;
}

void BlockTree::fill_surroundings(Surroundings& surroundings) const {
  const Level::Sides boxes = levels_[0].sides(0);
  lacuna::fill_surroundings(blocks_.data(), boxes.lows, boxes.highs, surroundings);
}

}  // namespace lacuna
