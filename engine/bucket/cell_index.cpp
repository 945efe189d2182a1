// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/cell_index.hpp"

#include "engine/store/openvdb.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace lacuna {
namespace {

using Tree = openvdb::Int32Tree;
using Leaf = Tree::LeafNodeType;
using Lower = Tree::RootNodeType::ChildNodeType::ChildNodeType;

openvdb::Coord coord_of(const CellCoord& cell) {
  return {cell[0], cell[1], cell[2]};
}

const Leaf* leaf_at(const Lower* node, const openvdb::Coord& cell) {
  if (node == nullptr) return nullptr;
  const openvdb::Index at = Lower::coordToOffset(cell);
  return node->isChildMaskOn(at) ? node->getTable()[at].getChild() : nullptr;
}

}  // namespace

struct CellIndex::Grid {
  CellGrid cells;
  openvdb::Int32Grid::Ptr numbers = openvdb::Int32Grid::create(-1);  // as `kNoCell`
};

CellIndex::CellIndex(const CellGrid& grid, std::span<const CountedCell> cells,
                     std::span<const CountedCell> heavy)
    : grid_(std::make_unique<Grid>(Grid{grid})) {
  auto numbers = grid_->numbers->getUnsafeAccessor();
  std::int32_t number = 0;
  for (const std::span<const CountedCell> part : {cells, heavy}) {
    for (const CountedCell& cell : part) numbers.setValueOn(coord_of(cell.coord), number++);
  }
}

CellIndex::CellIndex(CellIndex&&) noexcept = default;
CellIndex::~CellIndex() = default;

// The search goes in steps through the levels of the tree, each for many positions: the cache misses of
// positions in random order overlap.
void CellIndex::find(std::span<const Eigen::Vector3d> positions, std::span<std::uint32_t> numbers) const {
  assert(positions.size() == numbers.size());
  constexpr std::size_t kTogether = 256;
  static constexpr std::int32_t kNone = -1;
  std::array<CellCoord, kTogether> cells;
  std::array<const Lower*, kTogether> nodes;
  std::array<const Leaf*, kTogether> leaves;
  std::array<const std::int32_t*, kTogether> values;
  const auto accessor = grid_->numbers->getConstUnsafeAccessor();
  for (std::size_t first = 0; first < positions.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, positions.size() - first);
    grid_->cells.cells_of(positions.subspan(first, count), std::span(cells).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const openvdb::Coord cell = coord_of(cells[i]);
      nodes[i] = accessor.probeConstNode<Lower>(cell);
      if (nodes[i] != nullptr) __builtin_prefetch(nodes[i]->getTable() + Lower::coordToOffset(cell));
    }
    for (std::size_t i = 0; i < count; ++i) {
      leaves[i] = leaf_at(nodes[i], coord_of(cells[i]));
      __builtin_prefetch(leaves[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = leaves[i] == nullptr ? &kNone
                                       : leaves[i]->buffer().data() + Leaf::coordToOffset(coord_of(cells[i]));
      __builtin_prefetch(values[i]);
    }
    for (std::size_t i = 0; i < count; ++i) numbers[first + i] = static_cast<std::uint32_t>(*values[i]);
  }
}

}  // namespace lacuna
