// SPDX-License-Identifier: Apache-2.0
// Finds the cell that holds a place.
#pragma once

#include "engine/model/cell_grid.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace lacuna {

// A grid of OpenVDB with a number in each cell.
class CellIndex {
 public:
  static constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

  // `cells`, then `heavy`, numbered from 0.
  CellIndex(const CellGrid& grid, std::span<const CountedCell> cells,
            std::span<const CountedCell> heavy = {});
  CellIndex(CellIndex&&) noexcept;
  ~CellIndex();

  // Sets the number of each position's cell, and `kNoCell` where the cell has no number. From any thread.
  void find(std::span<const Eigen::Vector3d> positions, std::span<std::uint32_t> numbers) const;

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace lacuna
