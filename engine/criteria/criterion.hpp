// The criteria: how likely a point is to lie on a boundary, judged from its neighbourhood (paper, 4.2
// to 4.5).
#pragma once

#include "engine/config.hpp"
#include "engine/criteria/direction_gap.hpp"

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace lacuna {

// The surface around a point p, as its neighbours tell it. p itself takes part in no sum, and every sum is
// taken in neighbour order.
struct LocalSurface {
  double mean_distance = 0;     // r_p
  Eigen::Vector3d mean_offset;  // mu_p - p, weighted by exp(-d^2 / sigma^2)
  Eigen::Vector3d eigenvalues;  // of C_p, largest first
  bool has_normal = false;
  Eigen::Vector3d normal;  // unit
  DirectionGap gap;        // the largest among the neighbours' directions in the tangent plane
};

struct Criterion {
  const char* name;
  double CriteriaConfig::*weight;
  double (*probability)(const LocalSurface&);  // in [0, 1]
};

double angle_probability(const LocalSurface& surface);
double halfdisc_probability(const LocalSurface& surface);
double shape_probability(const LocalSurface& surface);

inline constexpr std::size_t kCriteria = 3;
inline constexpr std::array<Criterion, kCriteria> kCriteriaTable{{
    {"angle", &CriteriaConfig::weight_angle, angle_probability},
    {"halfdisc", &CriteriaConfig::weight_halfdisc, halfdisc_probability},
    {"shape", &CriteriaConfig::weight_shape, shape_probability},
}};

}  // namespace lacuna
