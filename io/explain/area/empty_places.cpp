// SPDX-License-Identifier: Apache-2.0
#include "io/explain/area/empty_places.hpp"

#include "engine/run/error.hpp"
#include "io/read/rows/columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <utility>

namespace lacuna::io {
namespace {

void sort_unique(std::vector<std::size_t>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

double spacing_of(std::uint64_t points, std::uint64_t cells) {
  return points > 0 ? std::sqrt(static_cast<double>(cells) / static_cast<double>(points))
                    : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::uint64_t PointDensity::area_of(std::size_t square, const PlanRaster& inside) const {
  const std::size_t from = square % columns_ * kEdge, to = std::min(from + kEdge, inside.columns());
  const std::size_t first = square / columns_ * kEdge;
  std::uint64_t cells = 0;
  for (std::size_t row = first; row < std::min(first + kEdge, inside.rows()); ++row)
    cells += count_bits(inside.row(row), from, to);
  return cells;
}

double PointDensity::spacing(const PlanRaster& inside) const {
  std::uint64_t points = 0, cells = 0;
  for (std::size_t square = 0; square < points_.size(); ++square) {
    if (points_[square] == 0) continue;
    points += points_[square];
    cells += area_of(square, inside);
  }
  return spacing_of(points, cells);
}

double PointDensity::spacing_around(const PlanPolygon& outline, const PlanRaster& inside) const {
  constexpr std::size_t kReach = 2;
  const std::size_t rows = points_.size() / columns_;
  std::vector<std::size_t> passed, around;  // squares
  for (const Ring2& ring : outline) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double steps = std::max(std::ceil((b - a).norm() / static_cast<double>(kEdge)), 1.0);
      for (double step = 0; step < steps; ++step) {
        const Eigen::Vector2d at = a + (b - a) * step / steps;
        passed.push_back(static_cast<std::size_t>(at.y()) / kEdge * columns_ +
                         static_cast<std::size_t>(at.x()) / kEdge);
      }
    }
  }
  sort_unique(passed);
  for (const std::size_t square : passed) {
    const std::size_t column = square % columns_, row = square / columns_;
    for (std::size_t r = row - std::min(row, kReach); r <= std::min(row + kReach, rows - 1); ++r)
      for (std::size_t c = column - std::min(column, kReach); c <= std::min(column + kReach, columns_ - 1);
           ++c)
        if (points_[r * columns_ + c] > 0) around.push_back(r * columns_ + c);
  }
  sort_unique(around);
  std::uint64_t points = 0, cells = 0;
  for (const std::size_t square : around) {
    if (std::binary_search(passed.begin(), passed.end(), square)) continue;
    points += points_[square];
    cells += area_of(square, inside);
  }
  return spacing_of(points, cells);
}

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

namespace {

constexpr double kToCorner = std::numbers::sqrt2 / 2;  // from the middle of a cell
constexpr double kToNeighbours = 1.5;                  // to the middles of the eight cells around

// Copies a column; leaves `values` empty where the rows have none of this name.
void load_if_any(const RowBatch& rows, const RowLayout& layout, const char* name,
                 std::vector<double>& values) {
  const Property* const column = layout.find_alike(name);
  values.clear();
  if (column != nullptr) load_column(rows, layout.stride, *column, values);
}

constexpr std::size_t kMostSwaths = 65'536;  // values of point_source_id in LAS

struct MeasuredPoint {
  Eigen::Vector3d place;
  double time = 0;   // 0: not stated
  double swath = 0;  // NaN: not stated
};

// Which points of an area are counted, and how.
struct Counting {
  bool takes_synthetic = false;
  bool once = true;                 // points that are there more than once
  double height_gap = 0;            // 0: all heights are ground
  std::vector<HeightGroup> ground;  // points of other heights cover nothing; empty: all count

  bool takes(double height) const { return ground.empty() || is_of(ground, height, height_gap); }
};

// Passes on the first returns of a scan that were measured, in cells.
class PlanObserver : public RowObserver {
 public:
  PlanObserver(const PlanGrid& grid, const Counting& counting, Progress& progress)
      : grid_(grid), counting_(counting), progress_(progress) {}

  void take(std::size_t, const ScanReader& reader, const RowBatch& rows, std::span<const Eigen::Vector3d>,
            std::span<const Eigen::Vector3d> kept) final {
    load_if_any(rows, reader.layout(), "return_number", returns_);
    load_if_any(rows, reader.layout(), "synthetic", synthetic_);
    load_if_any(rows, reader.layout(), "gps_time", times_);
    load_if_any(rows, reader.layout(), "point_source_id", swaths_);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (!kept[i].allFinite()) continue;
      const Eigen::Vector2d at = grid_.to_cells(kept[i].head<2>());
      const bool is_synthetic = !synthetic_.empty() && synthetic_[i] != 0;
      has_measured_ = has_measured_ || !is_synthetic;
      if (!returns_.empty() && returns_[i] > 1) {
        leave_out(at, &PlanOfPoints::later_returns);
      } else if (is_synthetic && !counting_.takes_synthetic) {
        leave_out(at, &PlanOfPoints::synthetic);
      } else if (counting_.takes(kept[i].z())) {
        add(at, {.place = kept[i],
                 .time = times_.empty() ? 0 : times_[i],
                 .swath = swaths_.empty() ? std::numeric_limits<double>::quiet_NaN() : swaths_[i]});
      }
    }
    progress_.advance(kept.size());
  }

  bool has_measured() const { return has_measured_; }

 protected:
  virtual void add(const Eigen::Vector2d& at, const MeasuredPoint& point) = 0;
  virtual void leave_out(const Eigen::Vector2d&, std::uint64_t PlanOfPoints::*) {}
  const PlanGrid& grid() const { return grid_; }
  const Counting& counting() const { return counting_; }

 private:
  const PlanGrid& grid_;
  const Counting& counting_;
  bool has_measured_ = false;
  Progress& progress_;
  std::vector<double> returns_, synthetic_, times_, swaths_;
};

// Finds the cells whose middles are empty, and those where no more than a corner may be.
class MarkingObserver : public PlanObserver {
 public:
  MarkingObserver(const PlanGrid& grid, const PlanRaster& inside, const AreaTiles& tiles,
                  const Counting& counting, CopyDistance copies, std::uint64_t memory, Progress& progress)
      : PlanObserver(grid, counting, progress),
        plan{.empty = inside, .density = PointDensity(grid)},
        maybe(inside),
        tiles(tiles),
        repeated(copies, memory),
        heights(counting.height_gap),
        inside_(inside) {}

  PlanOfPoints plan;
  PlanRaster maybe;
  ConvexHull hull;
  AreaTiles tiles;
  RepeatedPoints repeated;
  HeightGroups heights;

 private:
  bool is_inside(const Eigen::Vector2d& at) const {
    return grid().contains(at) &&
           inside_.has(static_cast<std::size_t>(at.x()), static_cast<std::size_t>(at.y()));
  }

  void add(const Eigen::Vector2d& at, const MeasuredPoint& point) final {
    clear_disc(at, kEmptyRadius, plan.empty);
    clear_disc(at, kEmptyRadius - kToCorner, maybe);
    if (!grid().contains(at)) return;
    hull.add(at);
    if (counting().height_gap > 0) heights.add(point.place.z());
    if (!is_inside(at) || (repeated.add(point.place, point.time) && counting().once)) return;
    if (!std::isnan(point.swath) && plan.swaths.size() < kMostSwaths) plan.swaths.insert(point.swath);
    const auto column = static_cast<std::size_t>(at.x()), row = static_cast<std::size_t>(at.y());
    ++plan.points;
    plan.density.add(column, row);
    tiles.add_point(column, row);
  }

  void leave_out(const Eigen::Vector2d& at, std::uint64_t PlanOfPoints::*count) final {
    if (is_inside(at)) ++(plan.*count);
  }

  const PlanRaster& inside_;
};

// Collects the points that are near a cell of a raster.
class NearObserver : public PlanObserver {
 public:
  NearObserver(const PlanGrid& grid, const PlanRaster& cells, const Counting& counting, std::uint64_t memory,
               Progress& progress)
      : PlanObserver(grid, counting, progress), cells_(cells), most_(memory / sizeof(Eigen::Vector2d)) {}

  std::vector<Eigen::Vector2d> near;

 private:
  void add(const Eigen::Vector2d& at, const MeasuredPoint&) final {
    if (!has_in_disc(at, kEmptyRadius + kToCorner, cells_)) return;
    if (near.size() >= most_)
      throw Error("void_rule: the points are so far apart that " + std::to_string(near.size()) +
                  " of them are near voids, more than fit in the memory limit; allowed: a larger size");
    near.push_back(at);
  }

  const PlanRaster& cells_;
  std::size_t most_;
};

// Points by rows of cells, and then from west to east.
class NearPoints {
 public:
  explicit NearPoints(std::vector<Eigen::Vector2d> points) : points_(std::move(points)) {
    std::sort(points_.begin(), points_.end(), is_before);
  }

  // Whether a place within `half` of the middle, along x and y, is empty.
  bool has_empty_place(const Eigen::Vector2d& middle, double half) const {
    const double distance = distance_from(middle);
    if (distance >= kEmptyRadius) return true;
    if (distance + half * std::numbers::sqrt2 < kEmptyRadius || half <= kLeastHalf) return false;
    for (const double x : {-half / 2, half / 2}) {
      for (const double y : {-half / 2, half / 2})
        if (has_empty_place(middle + Eigen::Vector2d(x, y), half / 2)) return true;
    }
    return false;
  }

 private:
  static constexpr double kLeastHalf = 1. / 128;

  static bool is_before(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::pair(std::floor(a.y()), a.x()) < std::pair(std::floor(b.y()), b.x());
  }

  double distance_from(const Eigen::Vector2d& place) const {
    double square = kEmptyRadius * kEmptyRadius;
    for (double row = std::floor(place.y() - kEmptyRadius); row <= place.y() + kEmptyRadius; ++row) {
      auto point = std::lower_bound(points_.begin(), points_.end(),
                                    Eigen::Vector2d(place.x() - kEmptyRadius, row), is_before);
      for (;
           point != points_.end() && std::floor(point->y()) == row && point->x() <= place.x() + kEmptyRadius;
           ++point)
        square = std::min(square, (*point - place).squaredNorm());
    }
    return std::sqrt(square);
  }

  std::vector<Eigen::Vector2d> points_;
};

}  // namespace

PlanOfPoints find_empty_places(const PlanGrid& grid, const PlanRaster& inside, const PointRules& rules,
                               std::uint64_t memory, const ScanFiles& scan, AreaTiles& tiles,
                               Progress& progress,
                               const std::function<bool(const PlanRaster& empty)>& has_voids) {
  // All is synthetic, not all points can be held, or heights lie apart: that shows in the end alone.
  Counting counting{.height_gap = rules.height_gap};
  std::vector<HeightGroup> apart;
  bool has_voids_with_apart = false;
  ScanCounts counts;
  std::unique_ptr<MarkingObserver> marking;
  for (bool is_again = true; is_again;) {
    marking.reset();
    marking =
        std::make_unique<MarkingObserver>(grid, inside, tiles, counting, rules.copies, memory, progress);
    progress.begin("area", scan.expected_points().value_or(0));
    counts = read_all(scan, *marking);
    const bool takes_synthetic = !marking->has_measured(), once = marking->repeated.is_exact();
    is_again = (takes_synthetic && !counting.takes_synthetic) || (!once && counting.once);
    HeightGroups::Parts heights = marking->heights.parts();
    if (!heights.apart.empty() && counting.ground.empty()) {
      is_again = true;
      has_voids_with_apart = has_voids(marking->plan.empty);
      counting.ground = std::move(heights.ground);
      apart = std::move(heights.apart);
    }
    counting.takes_synthetic = takes_synthetic;
    counting.once = once;
  }
  PlanOfPoints plan = std::move(marking->plan);
  plan.counts = std::move(counts);
  plan.hull = marking->hull.corners();
  plan.repeated = marking->repeated.count();
  plan.near = marking->repeated.near();
  plan.counts_once = counting.once;
  plan.all_synthetic = counting.takes_synthetic;
  plan.apart = std::move(apart);
  plan.has_voids_with_apart = has_voids_with_apart;
  PlanRaster undecided = std::move(marking->maybe);
  tiles = std::move(marking->tiles);
  marking.reset();

  undecided.subtract(plan.empty);
  if (undecided.count() > 0) {
    NearObserver collecting(grid, undecided, counting, memory, progress);
    progress.begin("voids", scan.expected_points().value_or(0));
    read_all(scan, collecting);
    const NearPoints near(std::move(collecting.near));
    std::vector<std::pair<std::size_t, std::size_t>> alone;  // row, column
    for (std::size_t row = 0; row < grid.rows; ++row) {
      undecided.for_each_in(row, [&](std::size_t column) {
        const Eigen::Vector2d middle(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
        if (!has_in_disc(middle, kToNeighbours, plan.empty) && near.has_empty_place(middle, 0.5))
          alone.emplace_back(row, column);
      });
    }
    for (const auto& [row, column] : alone) plan.empty.set(row, column, column + 1);
  }
  return plan;
}

}  // namespace lacuna::io
