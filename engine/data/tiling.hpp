// Where the points are: cells that hold them, a tree over the cells, and tiles cut from it.
#pragma once

#include "engine/data/ids.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {

using CellCoord = std::array<std::int32_t, 3>;

// a == b, which calls memcmp: too dear for every point.
inline bool same_cell(const CellCoord& a, const CellCoord& b) {
  return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0;
}

// Cells are cubes of edge 2^(finest + shift): `shift` doublings of the size that a survey began with. They are
// counted from an origin near the points, so a scan may stand anywhere on Earth with millimetre spacing. The
// origin is a whole number of finest cells along each axis, and cells are found by rounding down before it is
// subtracted: both steps are exact. Points more than `kLast` finest cells away belong to the last cell on that
// side, which therefore has no end. A point keeps its cell's ancestor however often cells are merged.
struct CellGrid {
  static constexpr std::int32_t kLast = 1 << 30;
  static constexpr int kMaxShift = 30;

  int finest = 0;  // within +-900, so that its powers of two are normal numbers
  int shift = 0;
  std::array<double, 3> origin{};  // in finest cells

  double edge() const;
  CellCoord cell_of(const Eigen::Vector3d& position) const;
  // The same for many, several at a time; some cell where a coordinate is not a number.
  void cells_of(std::span<const Eigen::Vector3d> positions, std::span<CellCoord> cells) const;
  // Smallest box that holds all points of the cells from `low` to `high`.
  Eigen::AlignedBox3d box(const CellCoord& low, const CellCoord& high) const;
};

struct CountedCell {
  CellCoord coord{};
  std::uint64_t points = 0;
};

// A run of cells in store order. A node's children are its two halves; leaves have none.
struct CellNode {
  CellCoord low{}, high{};            // tight bounds of its cells
  std::uint32_t first = 0, last = 0;  // cells [first, last)
  std::uint32_t left = 0, right = 0;  // nodes; 0: a leaf
  std::uint64_t points = 0;
};

// A tile's first row is a multiple of this, so that two tiles never share a word of a bitmap over rows.
inline constexpr std::uint64_t kRowAlignment = 64;

struct Tile {
  std::uint32_t first_cell = 0, last_cell = 0;
  Row first_row{};           // its rows: [first_row, first_row + points)
  std::uint64_t raw = 0;     // points with duplicates
  std::uint64_t points = 0;  // distinct points; known after bucketing

  bool owns(Row row) const { return value(row) - value(first_row) < points; }
  LocalIndex local(Row row) const { return static_cast<LocalIndex>(value(row) - value(first_row)); }
  Row row(LocalIndex owned) const { return Row{value(first_row) + owned}; }
};

using TileIndex = std::uint32_t;

// The index of a scan: boxes, counts and places, never points. Cells and tiles stand in the order of the
// tree (near in the order: near in space), which is also the order of points in the store.
struct Tiling {
  CellGrid grid;
  std::vector<CountedCell> cells;  // `points`: distinct ones after bucketing
  std::vector<Row> cell_rows;      // first row of each cell; known after bucketing
  std::vector<CellNode> nodes;     // nodes[0] is the root, where there are cells
  std::vector<Tile> tiles;

  TileIndex tile_of_cell(std::uint32_t cell) const;
  TileIndex tile_of_row(Row row) const;
  std::vector<TileIndex> tiles_of(std::span<const Row> rows) const;  // each once, in ascending order
  Eigen::AlignedBox3d box(const CellNode& node) const { return grid.box(node.low, node.high); }
  Eigen::AlignedBox3d cell_box(std::uint32_t cell) const {
    return grid.box(cells[cell].coord, cells[cell].coord);
  }
  std::uint64_t row_count() const;  // rows up to the last used one
  std::uint64_t points() const;     // distinct ones
  void recount();                   // nodes' points from the cells'

  // Whether tiles hold every cell once and in order, their rows apart from each other, rows of cells in
  // their tiles, and the nodes halve all cells. For asserts and tests.
  bool check() const;
};

// Lower and upper bound of the squared distance between a point of `a` and a point of `b`.
double min_squared_distance(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b);
double max_squared_distance(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b);

}  // namespace lacuna
