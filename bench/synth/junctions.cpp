// SPDX-License-Identifier: Apache-2.0
#include "bench/synth/junctions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna::synth {

namespace {

constexpr double kAbove = 5e-4;     // metres: a surface that touches there does not hide the place
constexpr double kTouching = 1e-3;  // metres
constexpr double kTouchingSteps =
    1.0 / 64;                // and steps of the lattice, since places on curves are that precise
constexpr int kGuesses = 6;  // along u and v
constexpr int kRefinements = 6;

struct Foot {
  double u, v, distance;
};

double distance(const Patch& patch, double u, double v, Vec3 place) {
  const Vec3 arm = patch.place(u, v) - place;
  return std::sqrt(dot(arm, arm));
}

// Finds the nearest place of the patch by compass search. It needs no derivatives, which a disc's corners
// lack.
Foot foot_on(const Patch& patch, Vec3 place) {
  constexpr double kSmallest = 1e-5;  // of the patch
  Foot best{0.5, 0.5, distance(patch, 0.5, 0.5, place)};
  for (double reach = 0.25; reach > kSmallest;) {
    const Foot middle = best;
    for (const double right : {-reach, 0.0, reach}) {
      for (const double up : {-reach, 0.0, reach}) {
        const double u = std::clamp(middle.u + right, 0.0, 1.0), v = std::clamp(middle.v + up, 0.0, 1.0);
        const double way = distance(patch, u, v, place);
        if (way < best.distance) best = {u, v, way};
      }
    }
    if (best.distance == middle.distance) reach *= 0.5;
  }
  return best;
}

bool all_around_sampled(const Lattice& lattice, const Foot& foot) {
  const double column = foot.u * (lattice.columns - 1), row = foot.v * (lattice.rows - 1);
  for (const double x : {std::floor(column), std::ceil(column)})
    for (const double y : {std::floor(row), std::ceil(row)})
      if (!lattice.is_sampled(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y))) return false;
  return true;
}

}  // namespace

Junctions::Junctions(const std::vector<Lattice>& lattices, const Visibility& visibility)
    : lattices_(lattices), visibility_(visibility) {
  for (const Lattice& lattice : lattices) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Bounds bounds{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
    for (std::int32_t row = 0; row < lattice.rows; ++row) {
      for (std::int32_t column = 0; column < lattice.columns; ++column) {
        const Vec3 p = lattice.at(column, row).position;
        bounds.low = {std::min(bounds.low.x, p.x), std::min(bounds.low.y, p.y), std::min(bounds.low.z, p.z)};
        bounds.high = {std::max(bounds.high.x, p.x), std::max(bounds.high.y, p.y),
                       std::max(bounds.high.z, p.z)};
      }
    }
    bounds_.push_back(bounds);
  }
}

bool Junctions::surface_goes_on(const CurveNode& place, std::size_t patch) const {
  const bool shadow = place.cause.kind == Cause::kShadow;
  const bool closed = place.cause.kind == Cause::kNone;
  const bool opening = place.cause.kind == Cause::kDoor;
  if (!place.at_end && !shadow && !closed && !opening) return false;
  const Vec3 p = place.position + kAbove * place.normal;
  for (std::size_t other = 0; other < lattices_.size(); ++other) {
    const Lattice& lattice = lattices_[other];
    if (other == patch || (shadow && lattice.patch.shape != place.cause.number)) continue;
    // A curve through a closed gap keeps to the lattice.
    const double step = std::max(lattice.step, lattices_[patch].step);
    const double reach = closed ? step : kTouching + kTouchingSteps * step;
    const auto [low, high] = bounds_[other];
    if (p.x < low.x - reach || p.y < low.y - reach || p.z < low.z - reach || p.x > high.x + reach ||
        p.y > high.y + reach || p.z > high.z + reach)
      continue;
    const Foot foot = foot_on(lattice.patch, p);
    if (foot.distance > reach) continue;
    const ScenePoint touched{lattice.patch.place(foot.u, foot.v), lattice.patch.normal(foot.u, foot.v),
                             lattice.patch.shape, lattice.patch.two_sided};
    if (all_around_sampled(lattice, foot) || visibility_.any(touched)) return true;
  }
  return false;
}

}  // namespace lacuna::synth
