// SPDX-License-Identifier: Apache-2.0
// Counts points per cell in a hash table.
#pragma once

#include "engine/model/cell_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// Counting stops at this number: such a cell is divided anyway.
inline constexpr std::uint64_t kMostCounted = (std::uint64_t{1} << 31) - 1;

// The order of the Z curve (Morton 1966) through the finest cells. So the cells within a larger cell follow
// each other, whatever its size. Equal cells come by their points.
struct AlongZCurve {
  bool operator()(const CountedCell& a, const CountedCell& b) const;
};

// Returns the doublings of the finest size after which both are in one cell.
int doublings_to_join(const CellCoord& a, const CellCoord& b);

// Returns the first finest cell within the cell of this size that holds `cell`.
inline CellCoord lowest_of(const CellCoord& cell, int doublings) {
  const std::int32_t kept = -1 << doublings;
  return {cell[0] & kept, cell[1] & kept, cell[2] & kept};
}

// Cells of any size are named by their first finest cell. The cell of an outlier takes no more than any
// other.
class CellTable {
 public:
  static constexpr std::uint64_t kBytesPerCell = 4 * sizeof(CountedCell);  // at most

  // Adds points to the cells of this size that hold the cells of the runs. Counts end at `kMostCounted`.
  void add(std::span<const CountedCell> runs, int doublings);
  std::size_t size() const { return size_; }  // cells with points
  // Returns the same points in cells of this size.
  CellTable merged(int doublings) const;
  // Calls visit(runs) with all cells, in no order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const CountedCell& slot : slots_) {
      if (slot.points > 0) visit(slot);
    }
  }

 private:
  std::size_t slot_of(const CellCoord& cell) const;
  void make_space(std::size_t cells);

  std::vector<CountedCell> slots_;  // a power of two; 0 points: no cell
  std::size_t size_ = 0;
};

}  // namespace lacuna
