#include "engine/bucket/cell_index.hpp"

#include "engine/survey/leaf_table.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace lacuna {

struct CellIndex::Grid {
  CellGrid cells;
  LeafTable<std::int32_t> leaves{-1};
};

CellIndex::CellIndex(const CellGrid& grid, std::span<const CountedCell> cells,
                     std::span<const CountedCell> aside)
    : grid_(std::make_unique<Grid>(Grid{grid})) {
  std::int32_t number = 0;
  for (const std::span<const CountedCell> part : {cells, aside}) {
    for (const CountedCell& cell : part) {
      const auto& entry = grid_->leaves.touch(cell.coord);
      entry.values[grid_->leaves.offset(cell.coord)] = number++;
    }
  }
}

CellIndex::~CellIndex() = default;

void CellIndex::find(std::span<const Eigen::Vector3d> positions, std::span<std::uint32_t> cells) const {
  assert(positions.size() == cells.size());
  static constexpr std::int32_t kNone = -1;
  const auto& leaves = grid_->leaves;
  std::array<CellCoord, 256> coords;
  std::array<const std::int32_t*, 256> numbers;
  for (std::size_t first = 0; first < positions.size(); first += coords.size()) {
    const std::size_t count = std::min(coords.size(), positions.size() - first);
    grid_->cells.cells_of(positions.subspan(first, count), std::span(coords).first(count));
    // Where all the numbers are, then the numbers: the cache misses of points in random order overlap.
    for (std::size_t i = 0; i < count; ++i) {
      const auto& entry = leaves.find(coords[i]);
      numbers[i] = entry.leaf == nullptr ? &kNone : entry.values + leaves.offset(coords[i]);
      __builtin_prefetch(numbers[i]);
    }
    for (std::size_t i = 0; i < count; ++i) cells[first + i] = static_cast<std::uint32_t>(*numbers[i]);
  }
}

}  // namespace lacuna
