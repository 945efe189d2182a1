// Halfdisc criterion (paper, 4.3): the neighbours of a boundary point fill half a disc.
#pragma once

#include "engine/criteria/surface.hpp"

namespace lacuna {
inline namespace LACUNA_LANES {

template <class Real>
LACUNA_INLINE Real halfdisc_probability(const Surface<Real>& surface) {
  // 4 r / (3 pi): how far the centroid of a half disc of radius r lies from its centre.
  const Real half_disc = 4.0 * surface.mean_distance / (3 * std::numbers::pi);
  const Real share = norm(in_plane(surface.mean_offset, surface.normal)) / half_disc;
  return select(surface.has_normal & (share < 1.0), share, Real{} + 1.0);
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
