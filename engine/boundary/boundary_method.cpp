// SPDX-License-Identifier: Apache-2.0
#include "engine/boundary/boundary_method.hpp"

#include "engine/boundary/paper/paper_boundary.hpp"
#include "engine/boundary/tangential/tangential_boundary.hpp"

namespace lacuna {

std::unique_ptr<BoundaryMethod> boundary_method(const Tiling& tiling, Job& job) {
  if (job.config.loops.method == LoopMethod::kPaper)
    return std::make_unique<paper::PaperBoundary>(tiling, job);
  return std::make_unique<tangential::TangentialBoundary>(tiling, job);
}

LoopPoint loop_point_of(const EvaluatedTile& tile, LocalIndex owned) {
  const Eigen::Vector3f surface = tile.evaluations[owned].mean_offset.cast<float>();
  return {tile.point(owned), {surface.x(), surface.y(), surface.z()}, tile.probability(owned)};
}

}  // namespace lacuna
