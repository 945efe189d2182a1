// Angle criterion (paper, 4.2): a boundary point sees its neighbours on one side only.
#pragma once

#include "engine/criteria/surface.hpp"

namespace lacuna {
inline namespace LACUNA_LANES {

// The gap against 2 pi / m, that of m evenly spread neighbours: without any hole it is 0. Differs from the
// paper: m counts the neighbours that have a direction, and fewer than three see a boundary.
template <class Real>
LACUNA_INLINE Real angle_probability(const Surface<Real>& surface) {
  constexpr double kPi = std::numbers::pi;
  const Real even = 2 * kPi / surface.gap.used;
  const Real probability = smaller(larger((surface.gap.size - even) / (kPi - even), Real{}), Real{} + 1.0);
  return select(surface.has_normal & (surface.gap.used >= 3.0), probability, Real{} + 1.0);
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
