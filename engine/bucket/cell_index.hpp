// From a place to the cell that holds it.
#pragma once

#include "engine/model/cell_grid.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace lacuna {

class CellIndex {
 public:
  static constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

  // Cells are numbered in this order: `cells`, then `aside`.
  CellIndex(const CellGrid& grid, std::span<const CountedCell> cells,
            std::span<const CountedCell> aside = {});
  ~CellIndex();

  // The cell of each position; `kNoCell` where none was counted. From any thread.
  void find(std::span<const Eigen::Vector3d> positions, std::span<std::uint32_t> cells) const;

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace lacuna
