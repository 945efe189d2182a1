// Numbers by cell, in OpenVDB's leaves of 8^3 cells, whatever the order of look-ups. OpenVDB's accessor
// remembers the leaf it was at last; elsewhere it walks down the tree, three places in memory that each tell
// the next. Here every leaf stands in one flat hash table beside its values: one place, the same for points
// in any order. And there is no tree above them: it takes 300 KB more for each leaf far from all others, as
// those of outliers are. Open addressing, at most half full, never smaller. Look-ups by several threads while
// nothing is added.
#pragma once

#include "engine/model/cell_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <openvdb/tree/LeafNode.h>

namespace lacuna {

template <class Value>
class LeafTable {
 public:
  using Leaf = openvdb::tree::LeafNode<Value, 3>;

  struct Entry {
    CellCoord block{};
    Leaf* leaf = nullptr;
    Value* values = nullptr;  // of the leaf's cells, by `offset`
  };

  // `background`: of cells in a new leaf, which are all off.
  explicit LeafTable(Value background) : background_(background) {}

  std::span<const std::unique_ptr<Leaf>> leaves() const { return leaves_; }
  std::uint64_t bytes() const { return leaves_.size() * (sizeof(Leaf) + Leaf::SIZE * sizeof(Value)); }

  // The leaf that holds the cell; `leaf` is null where the table has none.
  const Entry& find(const CellCoord& cell) const { return entries_[place(block_of(cell))]; }

  // The same, with a new leaf where there was none.
  const Entry& touch(const CellCoord& cell) {
    const Entry& known = find(cell);
    if (known.leaf != nullptr) return known;
    leaves_.push_back(std::make_unique<Leaf>(openvdb::Coord(cell[0], cell[1], cell[2]), background_));
    if (2 * leaves_.size() > entries_.size()) grow();
    Leaf& leaf = *leaves_.back();
    const CellCoord block = block_of(cell);
    return entries_[place(block)] = {block, &leaf, leaf.buffer().data()};
  }

  static std::uint32_t offset(const CellCoord& cell) {
    return Leaf::coordToOffset(openvdb::Coord(cell[0], cell[1], cell[2]));
  }

 private:
  static CellCoord block_of(const CellCoord& cell) {
    constexpr auto kLog2 = static_cast<int>(Leaf::LOG2DIM);
    return {cell[0] >> kLog2, cell[1] >> kLog2, cell[2] >> kLog2};
  }

  // Where the block's entry is, or would be.
  std::size_t place(const CellCoord& block) const {
    const auto part = [&](int axis) { return static_cast<std::uint64_t>(block[axis]); };
    const std::uint64_t mixed =
        part(0) * 0x9e3779b97f4a7c15 + part(1) * 0xc2b2ae3d27d4eb4f + part(2) * 0x165667b19e3779f9;
    const std::size_t last = entries_.size() - 1;
    std::size_t at = (mixed ^ mixed >> 32) & last;
    while (entries_[at].leaf != nullptr && !same_cell(entries_[at].block, block)) at = (at + 1) & last;
    return at;
  }

  void grow() {
    const std::vector<Entry> before = std::exchange(entries_, std::vector<Entry>(2 * entries_.size()));
    for (const Entry& entry : before) {
      if (entry.leaf != nullptr) entries_[place(entry.block)] = entry;
    }
  }

  Value background_;
  std::vector<std::unique_ptr<Leaf>> leaves_;
  std::vector<Entry> entries_ = std::vector<Entry>(64);
};

}  // namespace lacuna
