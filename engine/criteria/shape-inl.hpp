// SPDX-License-Identifier: Apache-2.0
// Shape criterion (paper, 4.4): the eigenvalues of the neighbourhood's covariance show what shape it has.
#if defined(LACUNA_CRITERIA_SHAPE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_CRITERIA_SHAPE_INL
#undef LACUNA_CRITERIA_SHAPE_INL
#else
#define LACUNA_CRITERIA_SHAPE_INL
#endif

#include "engine/criteria/surface-inl.hpp"
#include "engine/simd/maths-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

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

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
