// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/emptiness.hpp"

#include "engine/loops/loop_plane.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace lacuna {
namespace {

using Points = std::span<const LoopPoint>;

// A lid is a height above this plane.
LoopPlane plane_of(const LoopShape& shape) {
  Eigen::Index least = 0;
  shape.normal.cwiseAbs().minCoeff(&least);
  return {shape.centroid, shape.normal, shape.normal.cross(Eigen::Vector3d::Unit(least)).normalized()};
}

// A grid of nodes in a plane over the box of a loop.
struct Grid {
  Eigen::Vector2d first;
  double step;
  std::size_t columns, rows;

  Grid(const Eigen::AlignedBox2d& box, double step)
      : step(step),
        columns(static_cast<std::size_t>(box.sizes().x() / step) + 1),
        rows(static_cast<std::size_t>(box.sizes().y() / step) + 1) {
    first = box.center() - step / 2 * (Eigen::Vector2d(columns, rows) - Eigen::Vector2d::Ones());
  }
  double x(std::size_t column) const { return first.x() + static_cast<double>(column) * step; }
  double y(std::size_t row) const { return first.y() + static_cast<double>(row) * step; }
  std::size_t first_row_above(double y) const {
    return static_cast<std::size_t>(
        std::clamp(std::ceil((y - first.y()) / step), 0.0, static_cast<double>(rows)));
  }
};

// Returns the nodes of a grid that lie within the loop: with an odd number of edges to their right.
std::vector<Eigen::Vector2d> nodes_within(Points loop, const LoopPlane& plane, double area,
                                          Scratch& scratch) {
  constexpr double kPlaces = 64, kMostNodes = 4096;
  Eigen::AlignedBox2d box;
  scratch.for_each(loop, [&](const LoopPoint& p) { box.extend(plane(p.position()).head<2>()); });
  const Eigen::Vector2d size = box.sizes();
  const Grid grid(box, std::max(std::sqrt(std::max(area / kPlaces, size.prod() / kMostNodes)),
                                size.maxCoeff() / kMostNodes));
  std::vector<std::uint8_t> is_within(grid.columns * grid.rows);
  Eigen::Vector2d a = plane(loop.back().position()).head<2>();
  scratch.for_each(loop, [&](const LoopPoint& p) {
    const Eigen::Vector2d b = plane(p.position()).head<2>();
    const std::size_t last = grid.first_row_above(std::max(a.y(), b.y()));
    for (std::size_t row = grid.first_row_above(std::min(a.y(), b.y())); row < last; ++row) {
      const double x = a.x() + (grid.y(row) - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      for (std::size_t column = 0; column < grid.columns && grid.x(column) < x; ++column)
        is_within[row * grid.columns + column] ^= 1;
    }
    a = b;
  });
  std::vector<Eigen::Vector2d> nodes;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      if (is_within[row * grid.columns + column] != 0) nodes.emplace_back(grid.x(column), grid.y(row));
    }
  }
  return nodes;
}

// Lifts nodes to the lid: to the height of the loop, weighted by the inverse squared distance (Shepard, *A
// two-dimensional interpolation function*, 1968).
std::vector<Eigen::Vector3d> lifted(std::span<const Eigen::Vector2d> nodes, Points loop,
                                    const LoopPlane& plane, Scratch& scratch) {
  constexpr double kLeast = 1e-300;                                          // a node may lie on a point
  std::vector<Eigen::Vector2d> sums(nodes.size(), Eigen::Vector2d::Zero());  // of weights, and of heights
  scratch.for_each(loop, [&](const LoopPoint& p) {
    const Eigen::Vector3d at = plane(p.position());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      sums[i] += Eigen::Vector2d(1, at.z()) / std::max((nodes[i] - at.head<2>()).squaredNorm(), kLeast);
  });
  std::vector<Eigen::Vector3d> places;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    places.push_back(plane.point_at({nodes[i].x(), nodes[i].y(), sums[i].y() / sums[i].x()}));
  return places;
}

std::vector<double> squared_distances(std::span<const Eigen::Vector3d> places, Points loop,
                                      Scratch& scratch) {
  std::vector<double> distances(places.size(), std::numeric_limits<double>::infinity());
  scratch.for_each(loop, [&](const LoopPoint& p) {
    const Eigen::Vector3d at = p.position();
    for (std::size_t i = 0; i < places.size(); ++i)
      distances[i] = std::min(distances[i], (places[i] - at).squaredNorm());
  });
  return distances;
}

// Finds nearest points. It keeps the cells that it read last: places on one lid are near each other.
class NearestPoint {
 public:
  explicit NearestPoint(const TileStore& store) : store_(store), tiling_(store.tiling()) {}

  // Returns the squared distance to the nearest point, and at most `bound`.
  double squared_distance(const Eigen::Vector3d& from, double bound) {
    visit(0, from, bound);
    return bound;
  }

 private:
  static double squared_to(const CellNode& node, const Eigen::Vector3d& p) {
    return node.box.squaredExteriorDistance(p);
  }

  void visit(std::uint32_t index, const Eigen::Vector3d& from, double& best) {
    const CellNode& node = tiling_.nodes[index];
    if (node.left == 0) {
      for (std::uint32_t cell = node.first; cell < node.last; ++cell) {
        if (Eigen::AlignedBox3d(tiling_.cells[cell].box).squaredExteriorDistance(from) >= best) continue;
        for (const Eigen::Vector3d& p : points_of(cell)) best = std::min(best, (p - from).squaredNorm());
      }
      return;
    }
    std::uint32_t near = node.left, far = node.right;
    if (squared_to(tiling_.nodes[far], from) < squared_to(tiling_.nodes[near], from)) std::swap(near, far);
    for (const std::uint32_t child : {near, far}) {
      if (squared_to(tiling_.nodes[child], from) < best) visit(child, from, best);
    }
  }

  const std::vector<Eigen::Vector3d>& points_of(std::uint32_t cell) {
    constexpr std::size_t kMostCells = 64;
    if (const auto at = cells_.find(cell); at != cells_.end()) return at->second;
    if (cells_.size() == kMostCells) cells_.clear();
    std::vector<Eigen::Vector3d>& points = cells_[cell];
    for (const ScanPoint& p : store_.cell(cell)) points.push_back(p.position());
    return points;
  }

  const TileStore& store_;
  const Tiling& tiling_;
  std::unordered_map<std::uint32_t, std::vector<Eigen::Vector3d>> cells_;
};

}  // namespace

double emptiness(const TileStore& points, std::span<const LoopPoint> loop, const LoopShape& shape,
                 double spacing, Scratch& scratch) {
  constexpr double kDense = 0.8, kDeep = 4;  // spacings
  if (!(shape.area > 0) || !std::isfinite(shape.area)) return 0;
  const LoopPlane plane = plane_of(shape);
  const std::vector<Eigen::Vector3d> places =
      lifted(nodes_within(loop, plane, shape.area, scratch), loop, plane, scratch);
  const std::vector<double> to_loop = squared_distances(places, loop, scratch);
  NearestPoint nearest(points);
  double sum = 0, sum_to_loop = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double distance = std::sqrt(nearest.squared_distance(places[i], to_loop[i]));
    if (distance < kDense * spacing) continue;  // on an island, or at the loop
    sum += std::min(distance, kDeep * spacing);
    sum_to_loop += std::min(std::sqrt(to_loop[i]), kDeep * spacing);
  }
  return sum_to_loop > 0 ? sum / sum_to_loop : 1;
}

}  // namespace lacuna
