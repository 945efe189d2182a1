// From a place to the cell that holds it.
#pragma once

#include "engine/model/cell_grid.hpp"
#include "engine/model/tiling.hpp"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>

namespace lacuna {

// A grid of OpenVDB with a number in each cell. Its tree is OpenVDB's standard one, so that any program with
// OpenVDB can read the grid from disk. Far cells have no number: each would take 300 KB.
class CellIndex {
 public:
  static constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

  explicit CellIndex(const CellGrid& grid);
  // `cells`, then `aside`, numbered from 0.
  CellIndex(const CellGrid& grid, std::span<const CountedCell> cells,
            std::span<const CountedCell> aside = {});
  CellIndex(CellIndex&&) noexcept;
  ~CellIndex();

  const CellGrid& cells() const;

  // The number of each position's cell; `kNoCell` where the cell has none. From any thread.
  void find(std::span<const Eigen::Vector3d> positions, std::span<std::uint32_t> numbers) const;

  // Each cell of the grid that has a number gets that of the first cell of the tiling inside it. Those that
  // follow inside it have the next numbers.
  void number_by(const Tiling& tiling);

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;

  friend void save_index(const CellIndex& index, const Tiling& tiling, const std::filesystem::path& file);
  friend struct StoredIndex read_index(const std::filesystem::path& file);
};

}  // namespace lacuna
