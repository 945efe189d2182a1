// SPDX-License-Identifier: Apache-2.0
// A criterion of the test's own: how much the surface bends around a point. That is the share of the smallest
// eigenvalue (Pauly, Gross, Kobbelt, Efficient simplification of point-sampled surfaces, 2002), which is 1/3
// at most.
#if defined(LACUNA_TESTS_CURVATURE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_TESTS_CURVATURE_INL
#undef LACUNA_TESTS_CURVATURE_INL
#else
#define LACUNA_TESTS_CURVATURE_INL
#endif

#include "engine/criteria/surface-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

template <class V>
HWY_INLINE V curvature_probability(const Surface<V>& surface) {
  const Vector<V>& values = surface.eigenvalues;
  const V sum = (values.x + values.y) + values.z, zero = all<V>(0);
  const V share = all<V>(3) * hn::Max(values.z, zero) / sum;
  return hn::IfThenElseZero(sum > zero, hn::Min(share, all<V>(1)));
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
