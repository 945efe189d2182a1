// SPDX-License-Identifier: Apache-2.0
// The places of the points: cells that hold them, a tree over the cells, and tiles cut from the tree.
#pragma once

#include "engine/model/ids.hpp"
#include "engine/model/plain_box.hpp"
#include "engine/model/task_share.hpp"

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {

// A run of points in store order that lie near each other.
struct Cell {
  PlainBox box;  // of its points, and no larger
  Row first_row{};
  std::uint64_t points = 0;
};

// A run of cells in store order. A node's children are its two halves; leaves have none.
struct CellNode {
  Eigen::AlignedBox3d box;            // of its points
  std::uint32_t first = 0, last = 0;  // cells [first, last)
  std::uint32_t left = 0, right = 0;  // nodes; 0: a leaf
  std::uint64_t points = 0;
};

// A tile's first row is a multiple of this, so that two tiles never share a word of a bitmap over rows.
inline constexpr std::uint64_t kRowAlignment = 64;
constexpr std::uint64_t aligned_row(std::uint64_t row) {
  return (row + kRowAlignment - 1) / kRowAlignment * kRowAlignment;
}

struct Tile {
  std::uint32_t first_cell = 0, last_cell = 0;
  Row first_row{};           // its rows: [first_row, first_row + points)
  std::uint64_t raw = 0;     // rows that the store keeps for the tile: points with their copies
  std::uint64_t points = 0;  // distinct points; known after bucketing

  bool owns(Row row) const { return value(row) - value(first_row) < points; }
  LocalIndex local(Row row) const { return static_cast<LocalIndex>(value(row) - value(first_row)); }
  Row row(LocalIndex owned) const { return Row{value(first_row) + owned}; }
};

using TileIndex = std::uint32_t;

struct TileRange {
  TileIndex first = 0, last = 0;  // [first, last)
};

// The index of a scan. It holds boxes, counts and places, never points. Cells and tiles are in the order of
// points in the store. What is near in that order is near in space.
struct Tiling {
  static constexpr std::uint32_t kLeafCells = 4;

  std::vector<Cell> cells;
  std::vector<CellNode> nodes;  // nodes[0] is the root, where there are cells
  std::vector<Tile> tiles;

  // Halves the cells down to `kLeafCells`. A node of several tiles is halved between tiles, another one at
  // half of its points. Cost: linear in cells, except for the search of the halves.
  void build_tree();

  TileIndex tile_of_cell(std::uint32_t cell) const;
  TileIndex tile_of_row(Row row) const;
  std::vector<TileIndex> tiles_of(std::span<const Row> rows) const;  // each once, in ascending order
  std::uint64_t row_count() const;                                   // rows up to the last used one
  std::uint64_t points() const;                                      // distinct ones
  // Returns the tiles of a task. Tasks have about equally many points.
  TileRange tiles_in(const TaskShare& share) const;

  // Returns whether tiles hold every cell once and in order, and their rows do not overlap. Rows of cells lie
  // in their tiles, and the nodes halve all cells. For asserts and tests.
  bool check() const;

 private:
  std::uint32_t build_node(std::uint32_t first, std::uint32_t last);
  std::uint32_t halve(std::uint32_t first, std::uint32_t last) const;
};

// Return the lower and the upper bound of the squared distance between a point of `a` and a point of `b`.
double min_squared_distance(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b);
double max_squared_distance(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b);

}  // namespace lacuna
