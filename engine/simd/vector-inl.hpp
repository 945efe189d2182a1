// SPDX-License-Identifier: Apache-2.0
// Shorthands for Highway, and vectors of three numbers, each for several points at once.
#if defined(LACUNA_SIMD_VECTOR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_SIMD_VECTOR_INL
#undef LACUNA_SIMD_VECTOR_INL
#else
#define LACUNA_SIMD_VECTOR_INL
#endif

#include "engine/simd/targets.hpp"

#include <cstddef>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// As many numbers of a batch of eight as fit into a vector.
using Doubles = hn::CappedTag<double, 8>;
using Floats = hn::CappedTag<float, 8>;

template <class D>
inline constexpr std::size_t kLanes = hn::MaxLanes(D());

template <class V>
using TagOf = hn::DFromV<V>;
template <class V>
using MaskOf = hn::Mask<TagOf<V>>;

// Returns a vector with this number in each lane.
template <class V>
HWY_INLINE V all(double value) {
  return hn::Set(TagOf<V>(), static_cast<hn::TFromV<V>>(value));
}

template <class V>
HWY_INLINE bool any(hn::Mask<TagOf<V>> mask) {
  return !hn::AllFalse(TagOf<V>(), mask);
}

template <class V>
struct Vector {
  V x, y, z;

  friend HWY_INLINE Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend HWY_INLINE Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend HWY_INLINE Vector operator*(Vector a, V s) { return {a.x * s, a.y * s, a.z * s}; }
  friend HWY_INLINE Vector operator/(Vector a, V s) { return {a.x / s, a.y / s, a.z / s}; }
};

template <class V>
HWY_INLINE V dot(Vector<V> a, Vector<V> b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
template <class V>
HWY_INLINE Vector<V> cross(Vector<V> a, Vector<V> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V>
HWY_INLINE V norm(Vector<V> a) {
  return hn::Sqrt(dot(a, a));
}
template <class V>
HWY_INLINE Vector<V> select(MaskOf<V> mask, Vector<V> a, Vector<V> b) {
  return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y), hn::IfThenElse(mask, a.z, b.z)};
}

// Returns two directions at right angles to a normal and to each other, counterclockwise about it.
template <class V>
struct Frame {
  Vector<V> u, v;
};

// Duff et al., Building an Orthonormal Basis, Revisited (2017).
template <class V>
HWY_INLINE Frame<V> frame_of(Vector<V> normal) {
  const V one = all<V>(1), sign = hn::IfThenElse(normal.z < all<V>(0), all<V>(-1), one);
  const V s = all<V>(-1) / (sign + normal.z), t = normal.x * normal.y * s;
  return {{one + sign * normal.x * normal.x * s, sign * t, hn::Neg(sign) * normal.x},
          {t, sign + normal.y * normal.y * s, hn::Neg(normal.y)}};
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
