// SPDX-License-Identifier: Apache-2.0
#include "engine/survey/cell_tree.hpp"

#include "engine/store/openvdb.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <set>
#include <utility>

namespace lacuna {
namespace {

using Tree = openvdb::tree::Tree5<std::int32_t, 2, 2, 2, 3>::Type;
using Leaf = Tree::LeafNodeType;
using Top = Tree::RootNodeType::ChildNodeType;
using Region = Top::ChildNodeType;
using Bottom = Region::ChildNodeType;

constexpr std::uint64_t kLeafBytes = sizeof(Leaf) + Leaf::SIZE * sizeof(std::int32_t);
constexpr std::uint64_t kRootEntryBytes = 96;

// Runs that are counted at a time.
constexpr std::size_t kTogether = 256;

openvdb::Coord coord_of(const CellCoord& cell, int doublings) {
  return {cell[0] >> doublings, cell[1] >> doublings, cell[2] >> doublings};
}

std::uint64_t points_in(std::span<const Leaf* const> leaves) {
  std::uint64_t points = 0;
  for (const Leaf* leaf : leaves) {
    for (auto count = leaf->cbeginValueOn(); count; ++count) points += static_cast<std::uint64_t>(*count);
  }
  return points;
}

// Calls visit(leaves, points) for each region. Its leaves follow each other in the tree.
template <class Visit>
void for_each_region(const Tree& tree, Visit&& visit) {
  const auto region_of = [](const Leaf& leaf) { return leaf.origin() & openvdb::Int32(~(Region::DIM - 1)); };
  std::vector<const Leaf*> leaves;
  const auto end_region = [&] {
    if (!leaves.empty()) visit(std::span<const Leaf* const>(leaves), points_in(leaves));
    leaves.clear();
  };
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    if (!leaves.empty() && region_of(*leaves.front()) != region_of(*leaf)) end_region();
    leaves.push_back(leaf.getLeaf());
  }
  end_region();
}

}  // namespace

struct CellTree::Nodes {
  Tree tree{0};
  // Remembers a leaf and a top node. OpenVDB 10.0.1 finds wrong nodes where an accessor of a tree of five
  // levels remembers one of each level, as it would by default.
  openvdb::tree::ValueAccessor2<Tree, /*IsSafe=*/true, 0, 3> accessor{tree};
};

CellTree::CellTree() : nodes_(std::make_unique<Nodes>()) {}
CellTree::~CellTree() = default;
CellTree::CellTree(CellTree&&) noexcept = default;
CellTree& CellTree::operator=(CellTree&&) noexcept = default;

// All counts are located before any of them changes: the cache misses of points in random order overlap.
void CellTree::add(std::span<const CellRun> runs, int doublings) {
  struct Counter {
    Leaf* leaf;
    std::int32_t* count;
  };
  auto& accessor = nodes_->accessor;
  std::array<Counter, kTogether> counters;
  for (; !runs.empty(); runs = runs.subspan(std::min(runs.size(), kTogether))) {
    const std::size_t together = std::min(runs.size(), kTogether);
    for (std::size_t i = 0; i < together; ++i) {
      const openvdb::Coord cell = coord_of(runs[i].cell, doublings);
      Leaf* leaf = accessor.probeLeaf(cell);
      if (leaf == nullptr) {
        ++leaves_;
        regions_ += nodes_->tree.probeNode<Region>(cell) == nullptr;
        bottoms_ += nodes_->tree.probeNode<Bottom>(cell) == nullptr;
        leaf = accessor.touchLeaf(cell);
      }
      counters[i] = {leaf, leaf->buffer().data() + Leaf::coordToOffset(cell)};
      __builtin_prefetch(counters[i].count, 1);
    }
    for (std::size_t i = 0; i < together; ++i) {
      const auto& [leaf, count] = counters[i];
      if (*count == 0) {
        leaf->setValueOn(static_cast<openvdb::Index>(count - leaf->buffer().data()), 0);
        ++cells_;
      }
      *count = static_cast<std::int32_t>(
          std::min<std::int64_t>(std::int64_t{*count} + runs[i].points, kMostCounted));
    }
  }
}

CellTree CellTree::merged() const {
  CellTree merged;
  std::vector<CellRun> runs;
  for (auto leaf = nodes_->tree.cbeginLeaf(); leaf; ++leaf) {
    runs.clear();
    for (auto count = leaf->cbeginValueOn(); count; ++count) {
      const openvdb::Coord cell = count.getCoord();
      runs.push_back({{cell.x(), cell.y(), cell.z()}, *count});
    }
    merged.add(runs, 1);
  }
  return merged;
}

std::uint64_t CellTree::bytes() const {
  const std::uint64_t tops = nodes_->tree.root().getTableSize();
  return leaves_ * kLeafBytes + bottoms_ * sizeof(Bottom) + regions_ * sizeof(Region) +
         tops * (sizeof(Top) + kRootEntryBytes);
}

std::uint64_t CellTree::cells_with_neighbours() const {
  std::uint64_t alone = 0;
  for (auto leaf = nodes_->tree.cbeginLeaf(); leaf; ++leaf) alone += leaf->onVoxelCount() == 1;
  return cells_ - alone;
}

std::vector<CountedCell> CellTree::counted_cells(std::uint64_t few) const {
  std::vector<CountedCell> cells;
  cells.reserve(cells_);
  for_each_region(nodes_->tree, [&](std::span<const Leaf* const> leaves, std::uint64_t points) {
    for (const Leaf* leaf : leaves) {
      for (auto count = leaf->cbeginValueOn(); count; ++count) {
        const openvdb::Coord cell = count.getCoord();
        cells.push_back({{cell.x(), cell.y(), cell.z()}, static_cast<std::uint32_t>(*count), points < few});
      }
    }
  });
  return cells;
}

std::uint64_t CellTree::standard_bytes(std::uint64_t few) const {
  using Upper = openvdb::Int32Tree::RootNodeType::ChildNodeType;
  using Lower = Upper::ChildNodeType;
  static_assert(openvdb::Int32Tree::LeafNodeType::DIM == Leaf::DIM && Lower::DIM == Region::DIM);
  std::set<openvdb::Coord> uppers;
  std::uint64_t bytes = 0;
  for_each_region(nodes_->tree, [&](std::span<const Leaf* const> leaves, std::uint64_t points) {
    if (points < few) return;
    bytes += leaves.size() * kLeafBytes + sizeof(Lower);
    uppers.insert(leaves.front()->origin() & openvdb::Int32(~(Upper::DIM - 1)));
  });
  return bytes + uppers.size() * sizeof(Upper);
}

}  // namespace lacuna
