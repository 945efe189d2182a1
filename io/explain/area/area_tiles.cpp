// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/area_tiles.hpp"

#include <algorithm>

namespace lacuna::io {

AreaTiles::AreaTiles(double edge, const PlanGrid& grid) : grid_(grid) {
  if (!(edge > 0)) return;
  const Eigen::Array2d first = (grid.from_cells({0.5, 0.5}).array() / edge).floor();
  for (std::size_t i = 0; i < std::max(grid.columns, grid.rows); ++i) {
    const double middle = static_cast<double>(i) + 0.5;
    const Eigen::Array2d square = (grid.from_cells({middle, middle}).array() / edge).floor() - first;
    if (i < grid.columns) of_column_.push_back(static_cast<std::size_t>(square.x()));
    if (i < grid.rows) of_row_.push_back(static_cast<std::size_t>(square.y()));
  }
  columns_ = of_column_.back() + 1;
  tiles_.resize(columns_ * (of_row_.back() + 1));
  for (std::size_t i = 0; i < tiles_.size(); ++i)
    tiles_[i].tile.corner = {(first.x() + static_cast<double>(i % columns_)) * edge,
                             (first.y() + static_cast<double>(i / columns_)) * edge};
}

void AreaTiles::add_area(const PlanRaster& inside) {
  if (tiles_.empty()) return;
  for (std::size_t row = 0; row < inside.rows(); ++row) {
    for (std::size_t from = 0; from < inside.columns();) {
      const std::size_t to = static_cast<std::size_t>(
          std::upper_bound(of_column_.begin(), of_column_.end(), of_column_[from]) - of_column_.begin());
      at(from, row).cells += count_bits(inside.row(row), from, to);
      from = to;
    }
  }
}

void AreaTiles::add_void_cells(std::size_t row, std::size_t from, std::size_t to) {
  if (tiles_.empty()) return;
  for (; from < to; ++from) ++at(from, row).void_cells;
}

std::vector<AreaTile> AreaTiles::with_area() const {
  std::vector<AreaTile> tiles;
  for (const Tile& counted : tiles_) {
    if (counted.cells == 0) continue;
    AreaTile& tile = tiles.emplace_back(counted.tile);
    tile.area = grid_.area(counted.cells);
    tile.voids_area = grid_.area(counted.void_cells);
  }
  return tiles;
}

}  // namespace lacuna::io
