// The surface around a point, as its neighbours tell it: what the criteria judge. For a `Real` that is one
// number or those of several points (core/lanes).
#pragma once

#include "engine/core/vector.hpp"

namespace lacuna {
inline namespace LACUNA_LANES {

// What is left of `a` in the plane with this unit normal.
template <class Real>
LACUNA_INLINE Vector<Real> in_plane(Vector<Real> a, Vector<Real> normal) {
  return a - normal * dot(normal, a);
}

// The largest gap between the directions of a point's neighbours in its tangent plane (paper, 4.2).
// Neighbours are named by their rank in neighbour order.
template <class Real>
struct Gap {
  static constexpr double kNone = -1;

  Real size;  // radians; 2 pi with one direction
  Real used;  // m: neighbours that have a stable direction
  Real near;  // gap neighbours, nearer first; equal with one direction; kNone without any
  Real far;
};

template <class Mask, class Real>
LACUNA_INLINE Gap<Real> select(Mask mask, const Gap<Real>& a, const Gap<Real>& b) {
  return {select(mask, a.size, b.size), select(mask, a.used, b.used), select(mask, a.near, b.near),
          select(mask, a.far, b.far)};
}

// p itself takes part in no sum, and every sum is taken in neighbour order.
template <class Real>
struct Surface {
  using Mask = decltype(Real{} < Real{});

  Real mean_distance;        // r_p
  Vector<Real> mean_offset;  // mu_p - p, weighted by exp(-d^2 / sigma^2)
  Vector<Real> eigenvalues;  // of C_p up to a common factor, largest first
  Mask has_normal;
  Vector<Real> normal;  // unit
  Gap<Real> gap;
};

}  // namespace LACUNA_LANES
}  // namespace lacuna
