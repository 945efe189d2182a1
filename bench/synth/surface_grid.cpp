// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/surface_grid.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <array>
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

// Returns the multiple of `stride` nearest to `length`.
std::uint32_t whole_strides(double length, std::uint32_t stride) {
  return stride * static_cast<std::uint32_t>(std::floor(length / stride + 0.5));
}

}  // namespace

std::uint32_t root_of(std::uint32_t square) {
  std::uint32_t root = 1;
  while (root * root < square) ++root;
  return root;
}

SurfaceGrid lay_grid(const SurfaceOptions& options) {
  const auto [low, high] = options.hole_radius;
  const double hole_nodes = 0.5 * kTwoPi * (low * low + low * high + high * high) / 3;  // mean area of a hole
  const double kept = 0.5 + 0.5 / options.density_step;
  const double holes = static_cast<double>(options.holes) * hole_nodes;
  const double nodes = (static_cast<double>(options.points) + holes) / kept;
  const double side = std::sqrt(nodes / aspect(options.kind));
  if (side < kMinSide * root_of(options.density_step) || side * aspect(options.kind) > kMaxSide)
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
  grid.stride = root_of(options.density_step);
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
    const auto ring = [around = static_cast<double>(grid.columns)](double row) {
      return Outline{around, [=](double t) { return GridPosition{row, t * around}; }};
    };
    return {ring(0), ring(height)};
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

// ---- The shapes

namespace {

// A monotone map from 0 to 0 and 1 to 1. Its slope changes by the factor `stretch`, steadily from end to end.
// On a closed direction it changes once up and down.
double warp(double t, double stretch, bool closed) {
  if (stretch == 1) return t;
  const double swing = (stretch - 1) / (stretch + 1);
  if (closed) return t - swing / kTwoPi * sin_cos(t).sin;
  return t * (1 - swing + swing * t);
}

SurfacePoint on_waves(double u, double v, double width, double height) {
  const double amplitude = 0.02 * (width < height ? width : height);
  const auto [sin_u, cos_u] = sin_cos(3 * u);
  const auto [sin_v, cos_v] = sin_cos(2 * v);
  const double slope_u = amplitude * 3 * kTwoPi / width * cos_u * cos_v;
  const double slope_v = -amplitude * 2 * kTwoPi / height * sin_u * sin_v;
  return {{u * width, v * height, amplitude * sin_u * cos_v}, normalized({-slope_u, -slope_v, 1})};
}

SurfacePoint on_cylinder(double u, double v, double width, double height) {
  const double radius = width / kTwoPi;
  const auto [sin, cos] = sin_cos(u);
  return {{radius * cos, radius * sin, v * height}, {cos, sin, 0}};
}

SurfacePoint on_torus(double u, double v, double width, double height) {
  const double major = width / kTwoPi;
  const double minor = height / kTwoPi;
  const auto [sin_u, cos_u] = sin_cos(u);
  const auto [sin_v, cos_v] = sin_cos(v);
  const double ring = major + minor * cos_v;
  return {{ring * cos_u, ring * sin_u, minor * sin_v}, {cos_v * cos_u, cos_v * sin_u, sin_v}};
}

// A stereographic map, so that squares stay squares. The square sheet covers 53 degrees to each side of the
// pole.
SurfacePoint on_sphere_cap(double u, double v, double width, double height) {
  const double radius = 0.5 * width;
  const double x = 2 * u - 1;
  const double y = (2 * v - 1) * height / width;
  const double square = x * x + y * y;
  const double scale = 1 / (4 + square);
  const Vec3 normal{4 * scale * x, 4 * scale * y, scale * (4 - square)};
  return {radius * normal, normal};
}

// The directions of a face of a cube: outwards, and along u and v.
struct Face {
  Vec3 out, across, down;
};

constexpr std::array<Face, 6> kFaces{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                      {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
                                      {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                      {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                      {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}},
                                      {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}}};

SurfacePoint on_cube(const Face& face, double u, double v, double edge) {
  return {0.5 * edge * (face.out + (2 * u - 1) * face.across + (2 * v - 1) * face.down), face.out};
}

// Equal steps of u and v are equal angles at the middle. The sphere has the area of the cube.
SurfacePoint on_sphere(const Face& face, double u, double v, double edge) {
  const double radius = edge * std::sqrt(3 / kTwoPi);
  const auto [sin_u, cos_u] = sin_cos((2 * u - 1) / 8);
  const auto [sin_v, cos_v] = sin_cos((2 * v - 1) / 8);
  const Vec3 normal = normalized(face.out + sin_u / cos_u * face.across + sin_v / cos_v * face.down);
  return {radius * normal, normal};
}

}  // namespace

SurfaceShape::SurfaceShape(const SurfaceGrid& grid, const SurfaceOptions& options)
    : grid_(grid),
      kind_(options.kind),
      rows_(grid.rows - (grid.wrap_rows ? 0.0 : 1.0)),
      columns_(grid.columns - (grid.wrap_columns ? 0.0 : 1.0)),
      height_(rows_ * options.spacing),
      width_(columns_ * options.spacing),
      stretch_(std::sqrt(options.density_factor)) {}

// A point is at most half a step from its node, the middle of a square: it stays on its panel.
SurfacePoint SurfaceShape::on_panel(double row, double column) const {
  const double panel = std::min(std::floor((column + 0.5) / rows_), grid_.panels - 1.0);
  const double u = warp((column + 0.5) / rows_ - panel, stretch_, true);
  const double v = warp((row + 0.5) / rows_, stretch_, true);
  const Face& face = kFaces[static_cast<std::size_t>(panel)];
  return kind_ == SurfaceKind::kSphere ? on_sphere(face, u, v, height_) : on_cube(face, u, v, height_);
}

SurfacePoint SurfaceShape::at(double row, double column) const {
  if (grid_.panels > 1) return on_panel(row, column);
  const double u = warp(column / columns_, stretch_, grid_.wrap_columns);
  const double v = warp(row / rows_, stretch_, grid_.wrap_rows);
  switch (kind_) {
    case SurfaceKind::kWaves:
      return on_waves(u, v, width_, height_);
    case SurfaceKind::kCylinder:
      return on_cylinder(u, v, width_, height_);
    case SurfaceKind::kTorus:
      return on_torus(u, v, width_, height_);
    case SurfaceKind::kSphereCap:
      return on_sphere_cap(u, v, width_, height_);
    case SurfaceKind::kSphere:
    case SurfaceKind::kCube:
    case SurfaceKind::kPlane:
      break;
  }
  return {{u * width_, v * height_, 0}, {0, 0, 1}};
}

}  // namespace lacuna::synth
