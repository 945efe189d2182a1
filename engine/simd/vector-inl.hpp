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

// Numbers that lie side by side for each point, loaded for several points at once.
template <class V>
struct Pair {
  V first, second;
};

// Returns numbers `at` and `at + 1` of as many points as there are lanes.
#if HWY_TARGET == HWY_SCALAR
template <class D>
HWY_INLINE Pair<hn::Vec<D>> load_pair(D d, const double* const* points, std::size_t at) {
  return {hn::LoadU(d, points[0] + at), hn::LoadU(d, points[0] + at + 1)};
}
#else
// Both of each second point, from the first on.
template <class D>
HWY_INLINE hn::Vec<D> load_every_second(D d, const double* const* points, std::size_t at) {
  if constexpr (kLanes<D> == 2) {
    return hn::LoadU(d, points[0] + at);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, load_every_second(half, points + kLanes<D> / 2, at),
                       load_every_second(half, points, at));
  }
}
template <class D>
HWY_INLINE Pair<hn::Vec<D>> load_pair(D d, const double* const* points, std::size_t at) {
  const auto even = load_every_second(d, points, at), odd = load_every_second(d, points + 1, at);
  return {hn::InterleaveLower(d, even, odd), hn::InterleaveUpper(d, even, odd)};
}
#endif

// Loads points of three numbers each, and nothing beyond the last one's.
template <class D>
HWY_INLINE Vector<hn::Vec<D>> load_vectors(D d, const double* const* points) {
  const auto [x, y] = load_pair(d, points, 0);
  return {x, y, load_pair(d, points, 1).second};
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
