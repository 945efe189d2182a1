// SPDX-License-Identifier: Apache-2.0
// The criteria, each a formula over the surface around a point (paper, 4.2 to 4.4). A `V` holds the numbers of
// several points. To add a criterion: write its formula here, and its line in the table at the end.
#if defined(LACUNA_CRITERIA_FORMULAS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_CRITERIA_FORMULAS_INL
#undef LACUNA_CRITERIA_FORMULAS_INL
#else
#define LACUNA_CRITERIA_FORMULAS_INL
#endif

#include "engine/criteria/slice-inl.hpp"
#include "engine/simd/maths-inl.hpp"
#include "engine/simd/vector-inl.hpp"

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

// ---- The surface around a point, estimated from its neighbours

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

// ---- Angle criterion (4.2): the neighbours of a boundary point lie on one side only

// The criterion compares the gap with 2 pi / m, the gap of m evenly spread neighbours. Without any hole it is
// 0. Differs from the paper: m counts the neighbours that have a direction. With fewer than three, the point
// is a boundary.
template <class V>
HWY_INLINE V angle_probability(const Surface<V>& surface) {
  const V pi = all<V>(std::numbers::pi), one = all<V>(1);
  const V even = all<V>(2 * std::numbers::pi) / surface.gap.used;
  const V probability = hn::Min(hn::Max((surface.gap.size - even) / (pi - even), all<V>(0)), one);
  return hn::IfThenElse(hn::And(surface.has_normal, surface.gap.used >= all<V>(3)), probability, one);
}

// ---- Halfdisc criterion (4.3): the neighbours of a boundary point fill half a disc

template <class V>
HWY_INLINE V halfdisc_probability(const Surface<V>& surface) {
  // 4 r / (3 pi): how far the centroid of a half disc of radius r lies from its centre.
  const V half_disc = all<V>(4) * surface.mean_distance / all<V>(3 * std::numbers::pi);
  const V ratio = norm(in_plane(surface.mean_offset, surface.normal)) / half_disc;
  return hn::IfThenElse(hn::And(surface.has_normal, ratio < all<V>(1)), ratio, all<V>(1));
}

// ---- Shape criterion (4.4): the eigenvalues of the neighbourhood's covariance show what shape it has

struct CharacteristicShape {
  double eigenvalues[3];  // sum 1
  double squared_width;   // s^2 of its Gauss kernel
};

// s = |Lambda - c| / 3, with c the centroid of the triangle of interior, corner and line.
constexpr CharacteristicShape characteristic_shape(double first, double second, double third) {
  const double x = first - 11.0 / 18, y = second - 5.0 / 18, z = third - 1.0 / 9;
  return {{first, second, third}, ((x * x + y * y) + z * z) / 9};
}

inline constexpr CharacteristicShape kBoundaryShape = characteristic_shape(2.0 / 3, 1.0 / 3, 0);
inline constexpr CharacteristicShape kInteriorShape = characteristic_shape(1.0 / 2, 1.0 / 2, 0);
inline constexpr CharacteristicShape kCornerShape = characteristic_shape(1.0 / 3, 1.0 / 3, 1.0 / 3);
inline constexpr CharacteristicShape kLineShape = characteristic_shape(1, 0, 0);

template <class V>
HWY_INLINE Vector<V> eigenvalues_of(const CharacteristicShape& shape) {
  return {all<V>(shape.eigenvalues[0]), all<V>(shape.eigenvalues[1]), all<V>(shape.eigenvalues[2])};
}

template <class V>
HWY_INLINE V likeness(Vector<V> lambda, const CharacteristicShape& shape) {
  const Vector<V> difference = lambda - eigenvalues_of<V>(shape);
  return exponential(hn::Neg(dot(difference, difference)) / all<V>(shape.squared_width));
}

template <class V>
HWY_INLINE ShapeShares<V> shape_shares(const Surface<V>& surface) {
  const V zero = all<V>(0);
  const Vector<V>& values = surface.eigenvalues;
  const Vector<V> positive{hn::Max(values.x, zero), hn::Max(values.y, zero), hn::Max(values.z, zero)};
  const V sum = (positive.x + positive.y) + positive.z;
  const Vector<V> lambda = select(sum > zero, positive / sum, eigenvalues_of<V>(kCornerShape));
  const V boundary = likeness(lambda, kBoundaryShape);
  const V on_surface = boundary + likeness(lambda, kInteriorShape);
  const V total = (on_surface + likeness(lambda, kCornerShape)) + likeness(lambda, kLineShape);
  const MaskOf<V> is_any = total > zero;
  return {hn::IfThenElseZero(is_any, boundary / total), hn::IfThenElseZero(is_any, on_surface / total)};
}

template <class V>
HWY_INLINE V shape_probability(const Surface<V>& surface) {
  return surface.shape.boundary;
}

// ---- The table: formula, name, default of the weight, and its help

// The config, the combined probability, the stored results and the columns of the annotated scan all come from
// this table.
struct CriterionEntry {
  V (*formula)(const Surface<V>&);  // from 0 to 1
  const char* name;
  double default_weight;
  const char* help;
};

constexpr CriterionEntry kTable[] = {
    {angle_probability<V>, "angle", 1, "Share of the angle criterion; weights are divided by their sum."},
    {halfdisc_probability<V>, "halfdisc", 1, "Share of the halfdisc criterion."},
    {shape_probability<V>, "shape", 1, "Share of the shape criterion; more of it for noisy scans."},
};

inline constexpr std::size_t kCriteria = sizeof kTable / sizeof kTable[0];

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
