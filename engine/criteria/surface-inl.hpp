// SPDX-License-Identifier: Apache-2.0
// The surface around a point, estimated from its neighbours. The criteria are formulas over it. A `V` holds
// the numbers of several points.
#if defined(LACUNA_CRITERIA_SURFACE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_CRITERIA_SURFACE_INL
#undef LACUNA_CRITERIA_SURFACE_INL
#else
#define LACUNA_CRITERIA_SURFACE_INL
#endif

#include "engine/simd/vector-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

// Returns the part of `a` in the plane with this unit normal.
template <class V>
HWY_INLINE Vector<V> in_plane(Vector<V> a, Vector<V> normal) {
  return a - normal * dot(normal, a);
}

// The largest gap between the directions of a point's neighbours in its tangent plane (paper, 4.2).
// Neighbours are named by their rank in neighbour order.
template <class V>
struct Gap {
  V size;  // radians; 2 pi with one direction
  V used;  // m: neighbours that have a stable direction
  V near;  // gap neighbours, nearer first; equal with one direction; -1 without any
  V far;
};

template <class V>
HWY_INLINE Gap<V> select(MaskOf<V> mask, const Gap<V>& a, const Gap<V>& b) {
  return {hn::IfThenElse(mask, a.size, b.size), hn::IfThenElse(mask, a.used, b.used),
          hn::IfThenElse(mask, a.near, b.near), hn::IfThenElse(mask, a.far, b.far)};
}

// The shape of the neighbourhood: shares in [0, 1] of the kernels of the characteristic shapes (paper, 4.4).
template <class V>
struct ShapeShares {
  V boundary;
  V surface;  // boundary and interior: the rest are lines, corners and noise
};

// p itself takes part in no sum, and every sum is taken in neighbour order.
template <class V>
struct Surface {
  V mean_distance;        // r_p
  Vector<V> mean_offset;  // mu_p - p, weighted by exp(-d^2 / sigma^2)
  Vector<V> eigenvalues;  // of C_p up to a common factor, largest first
  MaskOf<V> has_normal;
  Vector<V> normal;  // unit
  Gap<V> gap;
  ShapeShares<V> shape;
};

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
