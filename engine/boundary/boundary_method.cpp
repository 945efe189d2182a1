// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/boundary_method.hpp"

namespace lacuna {

LoopPoint loop_point_of(const EvaluatedTile& tile, LocalIndex owned) {
  const Eigen::Vector3f surface = tile.evaluations[owned].mean_offset.cast<float>();
  return {tile.point(owned), {surface.x(), surface.y(), surface.z()}, tile.probability(owned)};
}

}  // namespace lacuna
