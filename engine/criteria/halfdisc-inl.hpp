// SPDX-License-Identifier: Apache-2.0
// Halfdisc criterion (paper, 4.3): the neighbours of a boundary point fill half a disc.
#if defined(LACUNA_CRITERIA_HALFDISC_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef LACUNA_CRITERIA_HALFDISC_INL
#undef LACUNA_CRITERIA_HALFDISC_INL
#else
#define LACUNA_CRITERIA_HALFDISC_INL
#endif

#include "engine/criteria/surface-inl.hpp"

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace lacuna::HWY_NAMESPACE {

template <class V>
HWY_INLINE V halfdisc_probability(const Surface<V>& surface) {
  // 4 r / (3 pi): how far the centroid of a half disc of radius r lies from its centre.
  const V half_disc = all<V>(4) * surface.mean_distance / all<V>(3 * std::numbers::pi);
  const V ratio = norm(in_plane(surface.mean_offset, surface.normal)) / half_disc;
  return hn::IfThenElse(hn::And(surface.has_normal, ratio < all<V>(1)), ratio, all<V>(1));
}

}  // namespace lacuna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
