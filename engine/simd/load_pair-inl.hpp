// SPDX-License-Identifier: Apache-2.0
// Numbers that lie side by side for each point, loaded for several points at once.
#if defined(LACUNA_SIMD_LOAD_PAIR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_SIMD_LOAD_PAIR_INL
#undef LACUNA_SIMD_LOAD_PAIR_INL
#else
#define LACUNA_SIMD_LOAD_PAIR_INL
#endif

#include "engine/simd/vector-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

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
