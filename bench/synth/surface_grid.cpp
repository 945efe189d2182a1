// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/surface_grid.hpp"

#include "bench/synth/trig.hpp"
#include "engine/run/error.hpp"

#include <cmath>
#include <string>

namespace lacuna::synth {

namespace {

constexpr double kMinSide = 8;
constexpr double kMaxSide = 0x1p31;
constexpr std::uint32_t kCubeFaces = 6;

// Returns the columns per row of the grid, for squares of about one spacing.
double aspect(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kCylinder:
      return 2;
    case SurfaceKind::kTorus:
      return 3;  // the major radius is three minor ones
    case SurfaceKind::kSphere:
    case SurfaceKind::kCube:
      return kCubeFaces;
    default:
      return 1;
  }
}

bool has_panels(SurfaceKind kind) {
  return kind == SurfaceKind::kSphere || kind == SurfaceKind::kCube;
}

std::uint32_t exact_root(std::uint32_t square) {
  std::uint32_t root = 1;
  while (root * root < square) ++root;
  return root;
}

// Returns the multiple of `stride` nearest to `length`.
std::uint32_t whole_strides(double length, std::uint32_t stride) {
  return stride * static_cast<std::uint32_t>(std::floor(length / stride + 0.5));
}

}  // namespace

SurfaceGrid lay_grid(const SurfaceOptions& options) {
  const auto [low, high] = options.hole_radius;
  const double hole_nodes = 0.5 * kTwoPi * (low * low + low * high + high * high) / 3;  // mean area of a hole
  const double kept = 0.5 + 0.5 / options.density_step;
  const double holes = static_cast<double>(options.holes) * hole_nodes;
  const double nodes = (static_cast<double>(options.points) + holes) / kept;
  const double side = std::sqrt(nodes / aspect(options.kind));
  if (side < kMinSide * exact_root(options.density_step) || side * aspect(options.kind) > kMaxSide)
    throw UsageError(
        "--points " + std::to_string(options.points) +
        ": this surface needs at least about 10 x 10 points in its sparsest part, and at most 2^31 in a row");

  SurfaceGrid grid;
  if (has_panels(options.kind)) {
    if (options.density_step > 1)
      throw UsageError("--density-step: not on a sphere or a cube, which have no halves");
    grid.panels = kCubeFaces;
    grid.wrap_rows = grid.wrap_columns = true;  // no outer edge
    grid.rows = whole_strides(side, 1);
    grid.columns = grid.panels * grid.rows;
    grid.step_column = grid.columns;
    return grid;
  }
  grid.stride = exact_root(options.density_step);
  grid.wrap_columns = options.kind == SurfaceKind::kCylinder || options.kind == SurfaceKind::kTorus;
  grid.wrap_rows = options.kind == SurfaceKind::kTorus;
  // An open side of n whole strides has n + 1 coarse rows, a closed one n.
  grid.rows = whole_strides(side, grid.stride) + (grid.wrap_rows ? 0 : 1);
  const double columns = nodes / grid.rows;
  grid.step_column = static_cast<std::uint32_t>(columns / 2);
  grid.columns =
      grid.step_column + whole_strides(columns - grid.step_column, grid.stride) + (grid.wrap_columns ? 0 : 1);
  return grid;
}

std::vector<NumberLoop> rims(const SurfaceGrid& grid) {
  if (grid.wrap_rows) return {};
  const std::uint32_t bottom = grid.rows - 1;
  const std::uint32_t right = grid.columns - 1;
  NumberLoop first, last;
  for (std::uint32_t column = 0; column < grid.columns; ++column) {
    if (!grid.exists(0, column)) continue;
    first.push_back(grid.node(0, column));
    last.push_back(grid.node(bottom, column));
  }
  if (grid.wrap_columns) return {first, last};
  NumberLoop around = first;
  for (std::uint32_t row = 1; row < bottom; ++row)
    if (grid.exists(row, right)) around.push_back(grid.node(row, right));
  around.insert(around.end(), last.rbegin(), last.rend());
  for (std::uint32_t row = bottom - 1; row > 0; --row) around.push_back(grid.node(row, 0));
  return {around};
}

std::vector<Outline> outer_edges(const SurfaceGrid& grid) {
  if (grid.wrap_rows) return {};
  const double height = grid.rows - 1.0;
  if (grid.wrap_columns) {
    const double around = grid.columns;
    return {{around,
             [=](double t) {
               return GridPosition{0, t * around};
             }},
            {around, [=](double t) {
               return GridPosition{height, t * around};
             }}};
  }
  const double width = grid.columns - 1.0;
  const double around = 2 * (height + width);
  // The curve begins in the middle of the first row, so that no corner is cut in two.
  return {{around, [=](double t) {
             double way = t * around + 0.5 * width;
             if (way >= around) way -= around;
             if (way < width) return GridPosition{0, way};
             if (way < width + height) return GridPosition{way - width, width};
             if (way < 2 * width + height) return GridPosition{height, 2 * width + height - way};
             return GridPosition{around - way, 0};
           }}};
}

}  // namespace lacuna::synth
