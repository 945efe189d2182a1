// SPDX-License-Identifier: Apache-2.0
// Polygons, rasters of bits and convex hulls, seen from above, and the shapes of a raster.
#pragma once

#include "engine/export.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lacuna::io {

using Ring2 = std::vector<Eigen::Vector2d>;  // closed; its first corner is not repeated

// A place is inside where a ray from it crosses an odd number of edges, of all rings. So the order of rings
// and their directions do not count.
using PlanPolygon = std::vector<Ring2>;

// Square cells, whole multiples of their edge from 0 0. Rows go from south to north, columns from west to
// east.
struct PlanGrid {
  static constexpr double kCells = 8;

  double size = 0;             // of so many cells in a row, in units of the scan
  Eigen::Array2d first{0, 0};  // the cell in the south-west, in cells from 0 0; whole numbers
  std::size_t columns = 0, rows = 0;

  // Returns the cells over a box, whose numbers fit into integers.
  static PlanGrid over(const Eigen::AlignedBox2d& box, double size);

  double edge() const { return size / kCells; }  // of a cell
  double area(std::uint64_t cells) const {
    return static_cast<double>(cells) * size * size / (kCells * kCells);
  }
  // Returns a place in cells from the south-west corner. The middle of the first cell is at 0.5 0.5.
  Eigen::Vector2d to_cells(const Eigen::Vector2d& place) const {
    return (place.array() * kCells / size - first).matrix();
  }
  Eigen::Vector2d from_cells(const Eigen::Vector2d& cells) const {
    return ((cells.array() + first) * size / kCells).matrix();
  }
  bool contains(const Eigen::Vector2d& cells) const {
    return cells.x() >= 0 && cells.y() >= 0 && cells.x() < static_cast<double>(columns) &&
           cells.y() < static_cast<double>(rows);
  }
};

double area_of(const PlanPolygon& polygon);  // the first ring is the outer one

class PlanRaster {
 public:
  explicit PlanRaster(const PlanGrid& grid)
      : columns_(grid.columns), words_of_row_((grid.columns + 63) / 64), words_(grid.rows * words_of_row_) {}

  static std::uint64_t bytes(const PlanGrid& grid) { return (grid.columns + 63) / 64 * 8 * grid.rows; }

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return words_of_row_ == 0 ? 0 : words_.size() / words_of_row_; }
  std::span<const std::uint64_t> row(std::size_t row) const {
    return {words_.data() + row * words_of_row_, words_of_row_};
  }
  bool has(std::size_t column, std::size_t row) const {
    return (words_[row * words_of_row_ + column / 64] >> column % 64 & 1) != 0;
  }
  // Sets and clears the cells [from, to) of a row.
  void set(std::size_t row, std::size_t from, std::size_t to);
  void clear(std::size_t row, std::size_t from, std::size_t to);
  std::uint64_t count() const;
  void fill();                             // sets all cells
  void subtract(const PlanRaster& other);  // of the same grid
  // Calls visit(column) for the set cells of a row, from west to east.
  template <class Visit>
  void for_each_in(std::size_t row, const Visit& visit) const {
    for (std::size_t word = 0; word < words_of_row_; ++word) {
      for (std::uint64_t bits = words_[row * words_of_row_ + word]; bits != 0; bits &= bits - 1)
        visit(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
    }
  }

 private:
  std::size_t columns_, words_of_row_;
  std::vector<std::uint64_t> words_;
};

// Counts the set bits [from, to) of a row.
std::uint64_t count_bits(std::span<const std::uint64_t> row, std::size_t from, std::size_t to);

// What the corners of a polygon are in.
enum class Frame { kScan, kCells };  // coordinates of the scan, or cells of a grid

// Calls visit(row, from, to) for cells [from, to) whose middles lie in the polygon; cells beyond the grid are
// left out. Rows ascend, and cells within a row. Memory: 4 MiB, or 32 bytes for each edge that a row crosses.
void for_each_run(const PlanPolygon& polygon, Frame frame, const PlanGrid& grid,
                  const std::function<void(std::size_t row, std::size_t from, std::size_t to)>& visit);

// Sets the cells whose middles lie in one of the polygons, which have coordinates of the scan.
PlanRaster rasterise(std::span<const PlanPolygon> polygons, const PlanGrid& grid);

// Clears the cells whose middles lie nearer to a place than `radius`. All are in cells.
void clear_disc(const Eigen::Vector2d& middle, double radius, PlanRaster& raster);
bool has_in_disc(const Eigen::Vector2d& middle, double radius, const PlanRaster& raster);

// Adds the cells of a row whose middles lie within `radius` of the middle of a set cell. The radius is in
// cells, and less than 64. `copy` writes the set cells of any row.
using CopyRow = std::function<void(std::size_t row, std::span<std::uint64_t> cells)>;
void grow_row(const PlanGrid& grid, const CopyRow& copy, std::size_t row, double radius,
              std::span<std::uint64_t> grown);

// Clears the cells [from, to) of a row.
void clear_bits(std::span<std::uint64_t> row, std::size_t from, std::size_t to);

// Memory: the hull, and some thousand points. Cost: the logarithm of that for each point.
class ConvexHull {
 public:
  void add(const Eigen::Vector2d& point) {
    points_.push_back(point);
    if (points_.size() >= 2 * kept_ + kBuffer) reduce();
  }
  // Returns its corners counter-clockwise; fewer than three where all points lie on a line.
  Ring2 corners() {
    reduce();
    return points_;
  }

 private:
  static constexpr std::size_t kBuffer = 4096;
  void reduce();

  Ring2 points_;
  std::size_t kept_ = 0;
};

// The shapes of a raster in plan, by GDAL and GEOS: voids, and the outline of a scan. Functions of
// lacuna_gis.so.

// Cells that GDAL reads row by row.
struct RasterRows {
  std::size_t columns, rows;
  // Writes the values of the cells of a row; 0: no part. It is called for each row several times.
  std::function<void(std::size_t row, std::span<std::uint8_t> values)> row;
};

// A part of the raster whose cells have the same value. Places are in cells.
struct TracedVoid {
  std::uint8_t value;
  PlanPolygon outline;           // along the edges of cells; the outer ring first
  Eigen::Vector2d middle{0, 0};  // of the largest circle that fits in
  double radius = 0;             // of that circle
};

struct TraceTask {
  RasterRows raster;
  std::vector<TracedVoid> voids;
};

// Fills in the voids: cells of one value that share edges. Throws `Error`. Cost: linear in cells; for the
// circles, the logarithm of the corners at some hundred places of each void.
using TraceVoids = void(TraceTask& task);

inline constexpr const char* kTraceVoids = "lacuna_trace_voids";
extern "C" LACUNA_API TraceVoids lacuna_trace_voids;

// Lengths and places are in cells.
struct OutlineTask {
  RasterRows covered;                 // 1: a cell whose middle is nearer to a point than `reach`
  double reach = 0, void_size = 0;    // `void_size`: how wide a bay must be at least
  std::vector<PlanPolygon> polygons;  // the outline
  bool has_bay = false;               // a bay is left out
};

// Fills in the outline: what is covered and what that encloses, without `reach` around it. So it joins points
// that are at most twice `reach` apart. Each of its polygons then takes in what lies between borders that are
// nearer to each other than a tenth of its own width. A bay lies between a polygon and its convex hull, and a
// circle of the void size fits in it. Where its mouth is wide, a larger circle must fit: of a tenth of that
// width, or of a fifth of the mouth. Polygons without a square of the edge 2 `reach` are left out. Throws
// `Error`. Cost: linear in cells; the logarithm of the corners of what is covered, for each corner.
using OutlineScan = void(OutlineTask& task);

inline constexpr const char* kOutlineScan = "lacuna_outline_scan";
extern "C" LACUNA_API OutlineScan lacuna_outline_scan;

}  // namespace lacuna::io
