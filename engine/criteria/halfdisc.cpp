// Halfdisc criterion (paper, 4.3): the neighbours of a boundary point fill half a disc.
#include "engine/criteria/criterion.hpp"

#include <algorithm>
#include <numbers>

namespace lacuna {

double halfdisc_probability(const LocalSurface& surface) {
  if (!surface.has_normal || surface.mean_distance == 0) return 1;
  const Eigen::Vector3d& mean = surface.mean_offset;
  const Eigen::Vector3d in_plane = mean - surface.normal * surface.normal.dot(mean);
  // 4 r / (3 pi): how far the centroid of a half disc of radius r lies from its centre.
  const double half_disc = 4 * surface.mean_distance / (3 * std::numbers::pi);
  return std::min(in_plane.norm() / half_disc, 1.0);
}

}  // namespace lacuna
