// SPDX-License-Identifier: Apache-2.0
// The scan's own outline.
//
// Idea: cells with points become coarser until nearly all have neighbours, as within an area. What lies
// within two cells of their points is covered. GDAL and GEOS draw the outline around that (plan_shapes.cpp).
#include "io/explain/area/check_area.hpp"
#include "io/read/crs/crs.hpp"
#include "io/read/scan/scan_pass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace lacuna::io {
namespace {

using PlanCell = std::pair<double, double>;  // whole numbers of edges

struct PlanCellHash {
  std::size_t operator()(const PlanCell& cell) const {
    return std::hash<double>{}(cell.first) * 31 + std::hash<double>{}(cell.second);
  }
};

// The points of a cell that are furthest to the east, west, north and south. Equal ones do not depend on the
// order of the points.
class FurthestPoints {
 public:
  explicit FurthestPoints(const Eigen::Vector2d& point) { points.fill(point); }

  void add(const Eigen::Vector2d& point) {
    for (std::size_t side = 0; side < points.size(); ++side)
      if (key(side, point) > key(side, points[side])) points[side] = point;
  }

  std::array<Eigen::Vector2d, 4> points;

 private:
  static std::pair<double, double> key(std::size_t side, const Eigen::Vector2d& point) {
    const double sign = side % 2 == 0 ? 1 : -1;
    return side < 2 ? std::pair(sign * point.x(), point.y()) : std::pair(sign * point.y(), point.x());
  }
};

// Holds the cells with points. Their edge is a power of two, and doubles where there are too many.
class PointCells : public RowObserver {
 public:
  explicit PointCells(Progress& progress) : progress_(progress) {}

  void take(std::size_t, const ScanReader&, const RowBatch&, std::span<const Eigen::Vector3d>,
            std::span<const Eigen::Vector3d> kept) final {
    for (const Eigen::Vector3d& point : kept) {
      if (!point.allFinite()) continue;
      if (cells.empty()) level_ = std::max(std::ilogb(point.head<2>().cwiseAbs().maxCoeff()), -kBits) - kBits;
      add(point.head<2>(), level_, cells);
      while (cells.size() > kMost) coarsen();
    }
    progress_.advance(kept.size());
  }

  double edge() const { return std::ldexp(1, level_); }

  void coarsen() {
    ++level_;
    Cells coarser;
    for (const auto& [cell, furthest] : cells)
      for (const Eigen::Vector2d& point : furthest.points)
        if (&point == &furthest.points[0] || point != furthest.points[0]) add(point, level_, coarser);
    cells = std::move(coarser);
  }

  // Whether nearly all cells have three neighbours or more. So corners of an area have, and lines have not.
  bool is_area() const {
    constexpr std::size_t kNeighbours = 3, kFew = 20;  // one in so many may be lone
    constexpr double kExact = std::uint64_t{1} << kBits;
    std::size_t lone = 0;
    for (const auto& [cell, furthest] : cells) {
      std::size_t near = 0;
      for_each_within(1, cell, [&](const PlanCell& other) { near += other != cell; });
      lone += near < kNeighbours || std::max(std::fabs(cell.first), std::fabs(cell.second)) > kExact;
      if (lone * kFew > cells.size()) return false;
    }
    return true;
  }

  // Calls visit(cell) for the cells with points so many cells around.
  template <class Visit>
  void for_each_within(int reach, const PlanCell& cell, const Visit& visit) const {
    for (int x = -reach; x <= reach; ++x)
      for (int y = -reach; y <= reach; ++y)
        if (const PlanCell other(cell.first + x, cell.second + y); cells.contains(other)) visit(other);
  }

  using Cells = std::unordered_map<PlanCell, FurthestPoints, PlanCellHash>;
  Cells cells;

 private:
  static constexpr std::size_t kMost = 1 << 16;
  static constexpr int kBits = 50;  // of the numbers of cells, so that all have neighbours

  static void add(const Eigen::Vector2d& point, int level, Cells& to) {
    const Eigen::Array2d at = (point.array() / std::ldexp(1, level)).floor() + 0.0;  // no -0
    const auto [place, is_new] = to.try_emplace(PlanCell(at.x(), at.y()), point);
    if (!is_new) place->second.add(point);
  }

  int level_ = 0;
  Progress& progress_;
};

constexpr int kReach = 2;  // in edges of cells

// Cells near each other.
struct CellGroup {
  std::vector<PlanCell> cells;
  Eigen::AlignedBox2d box;  // of their points, and the reach around
};

// Returns the groups of cells whose points may be within twice the reach. A group has a hundredth of the
// cells of the largest one at least.
std::vector<CellGroup> groups_of(const PointCells& points) {
  constexpr std::size_t kOfLargest = 100;
  std::vector<PlanCell> all;
  for (const auto& [cell, furthest] : points.cells) all.push_back(cell);
  std::sort(all.begin(), all.end());
  std::unordered_map<PlanCell, bool, PlanCellHash> is_taken;
  std::vector<CellGroup> groups;
  std::size_t largest = 0;
  for (const PlanCell& first : all) {
    if (is_taken[first]) continue;
    is_taken[first] = true;
    CellGroup group{.cells = {first}, .box = {}};
    for (std::size_t i = 0; i < group.cells.size(); ++i) {
      points.for_each_within(2 * kReach, PlanCell(group.cells[i]), [&](const PlanCell& other) {
        if (!std::exchange(is_taken[other], true)) group.cells.push_back(other);
      });
      for (const Eigen::Vector2d& point : points.cells.at(group.cells[i]).points) group.box.extend(point);
    }
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kReach * points.edge());
    group.box = Eigen::AlignedBox2d(group.box.min() - margin, group.box.max() + margin);
    largest = std::max(largest, group.cells.size());
    groups.push_back(std::move(group));
  }
  std::erase_if(groups, [&](const CellGroup& each) { return each.cells.size() * kOfLargest < largest; });
  return groups;
}

// Joins groups whose boxes overlap, or have half of their common box.
void join(std::vector<CellGroup>& groups) {
  constexpr double kMostLarger = 2;
  for (std::size_t i = 0; i < groups.size();) {
    const auto other = std::find_if(groups.begin() + static_cast<std::ptrdiff_t>(i) + 1, groups.end(),
                                    [&](const CellGroup& each) {
                                      const double both = groups[i].box.volume() + each.box.volume();
                                      return groups[i].box.intersects(each.box) ||
                                             groups[i].box.merged(each.box).volume() <= kMostLarger * both;
                                    });
    if (other == groups.end()) {
      ++i;
      continue;
    }
    groups[i].box.extend(other->box);
    groups[i].cells.insert(groups[i].cells.end(), other->cells.begin(), other->cells.end());
    groups.erase(other);
    i = 0;  // its box is larger, and may overlap with those before
  }
}

OutlineTask outline(const CellGroup& group, const PointCells& points, const PlanGrid& grid,
                    double void_size) {
  static auto* const outline =
      reinterpret_cast<OutlineScan*>(load_gis_function(kOutlineScan, "a check without --area"));
  PlanRaster empty(grid);
  empty.fill();
  for (const PlanCell& cell : group.cells)
    for (const Eigen::Vector2d& point : points.cells.at(cell).points)
      clear_disc(grid.to_cells(point), PlanGrid::kCells / 2, empty);
  OutlineTask task{.covered = {.columns = grid.columns,
                               .rows = grid.rows,
                               .row =
                                   [&](std::size_t row, std::span<std::uint8_t> values) {
                                     for (std::size_t column = 0; column < values.size(); ++column)
                                       values[column] = empty.has(column, row) ? 0 : 1;
                                   }},
                   .reach = PlanGrid::kCells / 2,
                   .void_size = void_size / grid.edge()};
  outline(task);
  for (PlanPolygon& polygon : task.polygons)
    for (Ring2& ring : polygon)
      for (Eigen::Vector2d& corner : ring) corner = grid.from_cells(corner);
  return task;
}

}  // namespace

PlanOutline outline_of_points(const ScanFiles& scan, double void_size, Progress& progress) {
  constexpr std::size_t kLeastCells = 8;
  constexpr double kMostCells = 1 << 25, kOfLargest = 0.01;
  PointCells points(progress);
  progress.begin("bounds", scan.expected_points().value_or(0));
  read_all(scan, points);
  std::vector<CellGroup> groups;
  const auto size = [&] { return 2 * kReach * points.edge(); };
  const auto fits = [&] {
    groups = groups_of(points);
    join(groups);
    const double cells = PlanGrid::kCells / size();
    return std::accumulate(groups.begin(), groups.end(), 0.0, [&](double sum, const CellGroup& group) {
             return sum + group.box.volume() * cells * cells;
           }) <= kMostCells;
  };
  while (points.cells.size() >= kLeastCells && !(points.is_area() && fits())) points.coarsen();
  PlanOutline result;
  if (points.cells.size() < kLeastCells) return result;
  result.cell = points.edge();
  double largest = 0;
  std::size_t kept = 0;
  for (const CellGroup& group : groups) {
    kept += group.cells.size();
    OutlineTask task = outline(group, points, PlanGrid::over(group.box, size()), void_size);
    for (const PlanPolygon& polygon : task.polygons) largest = std::max(largest, area_of(polygon));
    result.has_bay = result.has_bay || task.has_bay;
    result.groups.push_back(std::move(task.polygons));
  }
  const std::size_t cells = points.cells.size();
  result.has_dust = static_cast<double>(cells - kept) > kOfLargest * static_cast<double>(cells);
  for (std::vector<PlanPolygon>& polygons : result.groups)
    std::erase_if(polygons, [&](const PlanPolygon& each) { return area_of(each) < kOfLargest * largest; });
  std::erase_if(result.groups, [](const std::vector<PlanPolygon>& polygons) { return polygons.empty(); });
  return result;
}

}  // namespace lacuna::io
