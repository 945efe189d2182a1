// SPDX-License-Identifier: Apache-2.0
// find_empty_places: the cells of an area with a place that no point is near, and what is counted on the way.
//
// Idea: each point clears the cells whose middles it is near. What remains is empty. Cells of which only a
// corner may be empty are divided, in a second pass, with the points near them. No-data values and clouds
// leave a gap of heights to the ground, and cover nothing. Points that are in a scan more than once, as in
// tiles that overlap, count once.
#pragma once

#include "engine/run/progress.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/explain/area/plan_raster.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <vector>

namespace lacuna::io {

// Which points of a scan count when an area is checked.

// Divides heights at gaps without any height. A group is of the ground if it has a twentieth of the points or
// more, and more than one value. If none is so, it is the largest group. All other groups lie apart: rasters
// state one value for "no data", and returns of clouds, birds or mirrors are few. So steep ground, trees,
// towers and bridges belong to the ground, as long as their heights leave no such gap.
//
// The groups do not depend on the order of the heights. Memory: 24 bytes for each group, and 16,384 of them;
// heights beyond that lie apart.
class HeightGroups {
 public:
  explicit HeightGroups(double gap) : gap_(gap) {}

  void add(double height);

  // Both ascend. The groups of the ground are empty without a height.
  struct Parts {
    std::vector<HeightGroup> ground, apart;
  };
  Parts parts() const;

 private:
  double gap_;
  std::vector<HeightGroup> groups_;  // ascending
  std::size_t last_ = 0;             // the group of the last height
  std::uint64_t others_ = 0;         // heights beyond
};

// Whether a height is of one of the groups, or nearer to it than the gap.
bool is_of(const std::vector<HeightGroup>& groups, double height, double gap);

// How far two copies of a point lie apart at most, along each axis: files may round them differently. Both
// are above 0. Without a time, chance brings points near each other, too.
struct CopyDistance {
  double with_time, without_time;
};

// Holds a hash of each point, as long as all fit in `memory` bytes. Beyond that it goes on with an even
// sample, and is no longer exact. Two points of about one place and one time are the same: a second strip has
// other times.
class RepeatedPoints {
 public:
  RepeatedPoints(CopyDistance apart, std::uint64_t memory);

  // Whether the point was added before; `time` is 0 where it is not stated: then it must have the same place.
  // False for points that are not in the sample. Cost: a look-up, or up to eight for points near
  // the border of a cell.
  bool add(const Eigen::Vector3d& place, double time);
  bool is_exact() const { return sample_ == 0; }
  std::uint64_t count() const { return count_ << sample_; }  // an estimate if it is not exact
  // Likewise the points without a time that are near another one: copies, or there by chance.
  std::uint64_t near() const { return near_ << sample_; }

 private:
  // A cell and a time, as a hash, and the place within the cell, in steps along each axis.
  struct Key {
    std::uint64_t hash;
    std::array<int, 3> steps;
  };
  bool is_in_sample(std::uint64_t hash) const;
  std::size_t slot_of(std::uint64_t hash) const;
  int nearest(const Key& key) const;
  void put(std::uint64_t slot);
  void make_space();

  CopyDistance apart_;
  std::size_t most_;
  std::vector<std::uint64_t> slots_;  // the hash, and below it the steps; 0: free
  std::uint64_t used_ = 0, count_ = 0, near_ = 0;
  unsigned sample_ = 0;  // one cell in two to this power is in the sample
};

// The points, cell by cell.

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

// Returns the voids: circles around the empty places within the area, and beyond the convex hull of the
// points (check_area.hpp). Adds their cells to `tiles`. Throws `Error` where their outlines do not fit in
// memory.
std::vector<Void> find_voids(const PlanGrid& grid, const PlanRaster& inside,
                             const std::optional<PlanRaster>& excepted, const PlanOfPoints& points,
                             const FilesConfig& config, AreaTiles& tiles);

}  // namespace lacuna::io
