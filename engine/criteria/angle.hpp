// Angle criterion (paper, 4.2): a boundary point sees its neighbours on one side only.
#pragma once

#include "engine/criteria/surface.hpp"

namespace lacuna {
inline namespace LACUNA_LANES {

// Differs from the paper: the gap is measured against 2 pi / m, that of m evenly spread neighbours, so that
// a small neighbourhood without any hole scores 0.
template <class Real>
LACUNA_INLINE Real angle_probability(const Surface<Real>& surface) {
  constexpr double kPi = std::numbers::pi;
  const Real even = 2 * kPi / surface.gap.used;
  const Real probability = smaller(larger((surface.gap.size - even) / (kPi - even), Real{}), Real{} + 1.0);
  return select(surface.has_normal & (surface.gap.used >= 3.0), probability, Real{} + 1.0);
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
