// SPDX-License-Identifier: Apache-2.0
// Angle criterion (paper, 4.2): the neighbours of a boundary point lie on one side only.
#if defined(LACUNA_CRITERIA_ANGLE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_CRITERIA_ANGLE_INL
#undef LACUNA_CRITERIA_ANGLE_INL
#else
#define LACUNA_CRITERIA_ANGLE_INL
#endif

#include "engine/criteria/surface-inl.hpp"

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

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

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
