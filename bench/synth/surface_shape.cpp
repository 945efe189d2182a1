// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/surface_shape.hpp"

#include "bench/synth/trig.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lacuna::synth {

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
    : kind_(options.kind),
      wrap_rows_(grid.wrap_rows),
      wrap_columns_(grid.wrap_columns),
      panels_(grid.panels),
      rows_(grid.rows - (grid.wrap_rows ? 0.0 : 1.0)),
      columns_(grid.columns - (grid.wrap_columns ? 0.0 : 1.0)),
      height_(rows_ * options.spacing),
      width_(columns_ * options.spacing),
      stretch_(std::sqrt(options.density_factor)) {}

// A point is at most half a step from its node, the middle of a square: it stays on its panel.
SurfacePoint SurfaceShape::on_panel(double row, double column) const {
  const double panel = std::min(std::floor((column + 0.5) / rows_), panels_ - 1.0);
  const double u = warp((column + 0.5) / rows_ - panel, stretch_, true);
  const double v = warp((row + 0.5) / rows_, stretch_, true);
  const Face& face = kFaces[static_cast<std::size_t>(panel)];
  return kind_ == SurfaceKind::kSphere ? on_sphere(face, u, v, height_) : on_cube(face, u, v, height_);
}

SurfacePoint SurfaceShape::at(double row, double column) const {
  if (panels_ > 1) return on_panel(row, column);
  const double u = warp(column / columns_, stretch_, wrap_columns_);
  const double v = warp(row / rows_, stretch_, wrap_rows_);
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
