// SPDX-License-Identifier: Apache-2.0
// find_empty_places: the cells of an area with a place that no point is near, and what is counted on the way.
//
// Idea: each point clears the cells whose middles it is near. What remains is empty. Cells of which only a
// corner may be empty are divided, in a second pass, with the points near them.
#pragma once

#include "engine/run/progress.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/explain/area/plan_raster.hpp"
#include "io/explain/area/point_rules.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <vector>

namespace lacuna::io {

// Counts points in squares of kEdge x kEdge cells.
class PointDensity {
 public:
  static constexpr std::size_t kEdge = 8;

  explicit PointDensity(const PlanGrid& grid)
      : columns_(grid.columns / kEdge + 1), points_(columns_ * (grid.rows / kEdge + 1)) {}

  void add(std::size_t column, std::size_t row) { ++points_[row / kEdge * columns_ + column / kEdge]; }

  // Returns the spacing of the points in the squares that have any; NaN without points. It is in cells;
  // `inside` is the area.
  double spacing(const PlanRaster& inside) const;

  // Returns the spacing of the points around an outline. Squares with points count that are at most two
  // squares away from it, and that it does not pass. NaN without such squares. It is in cells, as is the
  // outline; `inside` is the area.
  double spacing_around(const PlanPolygon& outline, const PlanRaster& inside) const;

 private:
  std::uint64_t area_of(std::size_t square, const PlanRaster& inside) const;  // in cells

  std::size_t columns_;
  std::vector<std::uint32_t> points_;
};

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

// A place is empty if no point is nearer than this. In cells: half of the void size.
inline constexpr double kEmptyRadius = PlanGrid::kCells / 2;

// The points of a scan, seen from above.
struct PlanOfPoints {
  // Cells of the area whose middles are empty, and cells with another empty place without such a neighbour.
  PlanRaster empty;
  PointDensity density;
  Ring2 hull;  // convex, of the points in the bounds of the area; in cells
  // In the area: first returns that were measured, later returns, and others that were not measured.
  std::uint64_t points = 0, later_returns = 0, synthetic = 0;
  std::set<double> swaths;     // values of point_source_id of the points in the area
  std::uint64_t repeated = 0;  // points that are there once more; about so many where they do not count once
  std::uint64_t near = 0;      // points without a time that lie as near to another as its rounded copy may
  ScanCounts counts;           // of the pass over the scan
  bool counts_once = true;     // false: `points` has them as often as they are there
  bool all_synthetic = false;  // so that the whole scan has no other points, and these count
  std::vector<HeightGroup> apart;     // heights of points in the bounds of the area that cover nothing
  bool has_voids_with_apart = false;  // `has_voids` of the cells that are empty if these points count
};

// What a check of an area counts.
struct PointRules {
  double height_gap = 0;  // of HeightGroups; 0: all heights count
  CopyDistance copies;
};

// Reads the scan, without later returns and synthetic points. The first pass decides all cells but those
// whose middle is nearly empty. Where such cells are, a second pass collects the points near them. A cell is
// divided until its parts are decided, or 64 times smaller. So the size of a circle is exact to a five
// hundredth, whatever the grid. Adds the points to `tiles`. Repeated points count once, if `memory` bytes
// hold all points; else the pass is made again. So it is where heights of points lie apart; those cover
// nothing. `has_voids` gets the cells with empty middles after such a pass, and after the first one that
// holds; it may throw. Throws `Error` where the points near undecided cells need more than `memory` bytes.
PlanOfPoints find_empty_places(const PlanGrid& grid, const PlanRaster& inside, const PointRules& rules,
                               std::uint64_t memory, const ScanFiles& scan, AreaTiles& tiles,
                               Progress& progress,
                               const std::function<bool(const PlanRaster& empty)>& has_voids);

}  // namespace lacuna::io
