// SPDX-License-Identifier: Apache-2.0
#include "io/area/empty_places.hpp"

#include "engine/run/error.hpp"
#include "io/rows/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace lacuna::io {
namespace {

constexpr double kToCorner = std::numbers::sqrt2 / 2;  // from the middle of a cell
constexpr double kToNeighbours = 1.5;                  // to the middles of the eight cells around

// Passes on the first returns of a scan, in cells.
class PlanObserver : public RowObserver {
 public:
  PlanObserver(const PlanGrid& grid, Progress& progress) : grid_(grid), progress_(progress) {}

  void take(std::size_t, const ScanReader& reader, const RowBatch& rows, std::span<const Eigen::Vector3d>,
            std::span<const Eigen::Vector3d> kept) final {
    const Property* const returns = reader.layout().find_alike("return_number");
    if (returns != nullptr) load_column(rows, reader.layout().stride, *returns, returns_);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const bool is_first = returns == nullptr || returns_[i] <= 1;
      if (is_first && kept[i].allFinite()) add(grid_.to_cells(kept[i].head<2>()));
    }
    progress_.advance(kept.size());
  }

 protected:
  virtual void add(const Eigen::Vector2d& at) = 0;
  const PlanGrid& grid() const { return grid_; }

 private:
  const PlanGrid& grid_;
  Progress& progress_;
  std::vector<double> returns_;
};

// Finds the cells whose middles are empty, and those where no more than a corner may be.
class MarkingObserver : public PlanObserver {
 public:
  MarkingObserver(const PlanGrid& grid, const PlanRaster& inside, AreaTiles& tiles, Progress& progress)
      : PlanObserver(grid, progress),
        plan{.empty = inside, .density = PointDensity(grid)},
        maybe(inside),
        inside_(inside),
        tiles_(tiles) {}

  PlanOfPoints plan;
  PlanRaster maybe;
  ConvexHull hull;

 private:
  void add(const Eigen::Vector2d& at) final {
    clear_disc(at, kEmptyRadius, plan.empty);
    clear_disc(at, kEmptyRadius - kToCorner, maybe);
    if (!grid().contains(at)) return;
    hull.add(at);
    const auto column = static_cast<std::size_t>(at.x()), row = static_cast<std::size_t>(at.y());
    if (!inside_.has(column, row)) return;
    ++plan.points;
    plan.density.add(column, row);
    tiles_.add_point(column, row);
  }

  const PlanRaster& inside_;
  AreaTiles& tiles_;
};

// Collects the points that are near a cell of a raster.
class NearObserver : public PlanObserver {
 public:
  NearObserver(const PlanGrid& grid, const PlanRaster& cells, std::uint64_t memory, Progress& progress)
      : PlanObserver(grid, progress), cells_(cells), most_(memory / sizeof(Eigen::Vector2d)) {}

  std::vector<Eigen::Vector2d> near;

 private:
  void add(const Eigen::Vector2d& at) final {
    if (!has_in_disc(at, kEmptyRadius + kToCorner, cells_)) return;
    if (near.size() >= most_)
      throw Error("void_size: the points are so far apart that " + std::to_string(near.size()) +
                  " of them are near voids, more than fit in the memory limit; allowed: a larger one");
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

PlanOfPoints find_empty_places(const PlanGrid& grid, const PlanRaster& inside, std::uint64_t memory,
                               FileScan& scan, AreaTiles& tiles, Progress& progress) {
  MarkingObserver marking(grid, inside, tiles, progress);
  progress.begin("area", scan.expected_points().value_or(0));
  scan.read_all(marking);
  PlanOfPoints plan = std::move(marking.plan);
  plan.hull = marking.hull.corners();

  PlanRaster& undecided = marking.maybe;
  undecided.subtract(plan.empty);
  if (undecided.count() > 0) {
    NearObserver collecting(grid, undecided, memory, progress);
    progress.begin("voids", scan.expected_points().value_or(0));
    scan.read_all(collecting);
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
