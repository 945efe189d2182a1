// Angle criterion (paper, 4.2): a boundary point sees its neighbours on one side only.
#include "engine/criteria/criterion.hpp"

#include <algorithm>
#include <numbers>

namespace lacuna {

// Differs from the paper: the gap is measured against 2 pi / m, that of m evenly spread neighbours, so that
// a small neighbourhood without any hole scores 0.
double angle_probability(const LocalSurface& surface) {
  constexpr double kPi = std::numbers::pi;
  if (!surface.has_normal || surface.gap.used < 3) return 1;
  const double even = 2 * kPi / static_cast<double>(surface.gap.used);
  return std::clamp((surface.gap.size - even) / (kPi - even), 0.0, 1.0);
}

}  // namespace lacuna
