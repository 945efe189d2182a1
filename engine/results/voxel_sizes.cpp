// SPDX-License-Identifier: Apache-2.0
#include "engine/results/voxel_sizes.hpp"

#include "engine/bucket/z_curve.hpp"
#include "engine/store/openvdb.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace lacuna {
namespace {

using Tree = openvdb::FloatTree;
using Upper = Tree::RootNodeType::ChildNodeType;
using Lower = Upper::ChildNodeType;
using Leaf = Tree::LeafNodeType;

constexpr std::uint64_t kLeafBytes = sizeof(Leaf) + Leaf::SIZE * sizeof(float);
constexpr int kLeafBits = Leaf::TOTAL, kLowerBits = Lower::TOTAL, kUpperBits = Upper::TOTAL;

// With the sign's bit turned, coordinates are in the order of their bits.
std::uint32_t bits_of(std::int32_t coordinate) {
  return static_cast<std::uint32_t>(coordinate) ^ 0x80000000;
}

// Voxels that share all but the lowest `bits` bits of each coordinate are in the same node.
int differing_bits(const CellCoord& a, const CellCoord& b) {
  std::uint32_t differing = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) differing |= bits_of(a[axis]) ^ bits_of(b[axis]);
  return static_cast<int>(std::bit_width(differing));
}

}  // namespace

bool comes_before_along_z(const CellCoord& a, const CellCoord& b) {
  return comes_before(ZPlace{bits_of(a[0]), bits_of(a[1]), bits_of(a[2])},
                      ZPlace{bits_of(b[0]), bits_of(b[1]), bits_of(b[2])});
}

CellCoord VoxelSizes::node_of(const CellCoord& voxel, int doublings) {
  const int bits = std::min(kUpperBits + doublings, 31);
  return {voxel[0] >> bits, voxel[1] >> bits, voxel[2] >> bits};
}

void VoxelSizes::add(const CellCoord& voxel, std::uint64_t points) {
  const int differing = std::exchange(is_first_, false) ? 32 : differing_bits(last_, voxel);
  for (int doublings = 0; doublings <= kMostDoublings; ++doublings) {
    Level& level = levels_[static_cast<std::size_t>(doublings)];
    if (differing > kUpperBits + doublings) {
      end_node(doublings);
      level.node_bytes = sizeof(Upper);
    }
    if (differing > kLowerBits + doublings) level.node_bytes += sizeof(Lower);
    if (differing > kLeafBits + doublings) level.node_bytes += kLeafBytes;
    level.node_points += points;
  }
  last_ = voxel;
}

void VoxelSizes::finish() {
  for (int doublings = 0; doublings <= kMostDoublings; ++doublings) end_node(doublings);
}

void VoxelSizes::end_node(int doublings) {
  Level& level = levels_[static_cast<std::size_t>(doublings)];
  const std::uint64_t bytes = std::exchange(level.node_bytes, 0);
  const std::uint64_t points = std::exchange(level.node_points, 0);
  if (points == 0 || points < all_points_ / 1000) return;
  level.bytes += bytes;
  level.kept.push_back(node_of(last_, doublings));
}

int VoxelSizes::doublings_within(std::uint64_t bytes) const {
  const auto fits = [&](const Level& level) { return level.bytes <= bytes; };
  const auto found = std::find_if(levels_.begin(), levels_.end(), fits);
  return std::min(static_cast<int>(found - levels_.begin()), kMostDoublings);
}

}  // namespace lacuna
