// SPDX-License-Identifier: Apache-2.0
// The squares of an area's table.
#pragma once

#include "io/explain/area/area_check.hpp"
#include "io/explain/area/plan_raster.hpp"

#include <cstddef>
#include <vector>

namespace lacuna::io {

// Squares are whole multiples of their edge from 0 0. A cell belongs to the square that its middle lies in.
// Without an edge there is no square, and nothing is counted.
class AreaTiles {
 public:
  AreaTiles(double edge, const PlanGrid& grid);

  void add_point(std::size_t column, std::size_t row) {
    if (!tiles_.empty()) ++at(column, row).tile.points;
  }
  void add_void(std::size_t column, std::size_t row) {
    if (!tiles_.empty()) ++at(column, row).tile.voids;
  }
  void add_area(const PlanRaster& inside);
  void add_void_cells(std::size_t row, std::size_t from, std::size_t to);
  // Returns the squares with a part of the area.
  std::vector<AreaTile> with_area() const;

 private:
  struct Tile {
    AreaTile tile;
    std::uint64_t cells = 0, void_cells = 0;
  };
  Tile& at(std::size_t column, std::size_t row) {
    return tiles_[of_row_[row] * columns_ + of_column_[column]];
  }

  PlanGrid grid_;
  std::size_t columns_ = 0;
  std::vector<std::size_t> of_column_, of_row_;  // squares of the cells
  std::vector<Tile> tiles_;
};

}  // namespace lacuna::io
