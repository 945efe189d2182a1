// The criteria: how likely a point is to lie on a boundary, judged from its neighbourhood (paper, 4.2
// to 4.5). Each has a formula over the `Surface` around the point, in a header of its own.
#pragma once

#include "engine/config.hpp"

#include <array>
#include <cstddef>

namespace lacuna {

struct Criterion {
  const char* name;
  double CriteriaConfig::*weight;
};

inline constexpr std::size_t kCriteria = 3;
inline constexpr std::size_t kAngle = 0, kHalfdisc = 1;  // places in the table
inline constexpr std::array<Criterion, kCriteria> kCriteriaTable{{
    {"angle", &CriteriaConfig::weight_angle},
    {"halfdisc", &CriteriaConfig::weight_halfdisc},
    {"shape", &CriteriaConfig::weight_shape},
}};

}  // namespace lacuna
