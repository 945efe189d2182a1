// SPDX-License-Identifier: Apache-2.0
// Counts points per cell in an OpenVDB tree.
#pragma once

#include "engine/model/cell_grid.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lacuna {

// Consecutive points in the same cell.
struct CellRun {
  CellCoord cell{};
  std::int32_t points = 0;
};

// Counting stops at this number: such a cell is divided anyway.
inline constexpr std::uint64_t kMostCounted = (std::uint64_t{1} << 31) - 1;

// Leaves hold 8^3 cells, as in OpenVDB's standard tree. Above them are three levels of 4^3 nodes, since each
// far outlier has nodes of its own. They take 4 KB here, and 300 KB in the standard tree.
class CellTree {
 public:
  CellTree();
  ~CellTree();
  CellTree(CellTree&&) noexcept;
  CellTree& operator=(CellTree&&) noexcept;

  // `doublings`: from the cell size of the runs to the cell size of the tree. Counts end at `kMostCounted`.
  void add(std::span<const CellRun> runs, int doublings);
  // Returns the same points in cells of twice the size. Cost: linear in cells.
  CellTree merged() const;

  std::uint64_t cells() const { return cells_; }
  std::uint64_t leaves() const { return leaves_; }
  std::uint64_t bytes() const;  // of all nodes
  // Returns the number of cells that share their leaf with others. Cells of outliers are alone in their leaf.
  std::uint64_t cells_with_neighbours() const;

  // Returns every cell, with its count, in an order that depends on the cells alone. A cell is far where its
  // region of 128^3 cells holds fewer than `few` points.
  std::vector<CountedCell> counted_cells(std::uint64_t few) const;
  // Returns the bytes of OpenVDB's standard tree with the cells that are not far.
  std::uint64_t standard_bytes(std::uint64_t few) const;

 private:
  struct Nodes;
  std::unique_ptr<Nodes> nodes_;
  std::uint64_t cells_ = 0, leaves_ = 0, bottoms_ = 0, regions_ = 0;
};

}  // namespace lacuna
