// SPDX-License-Identifier: Apache-2.0
// Who takes the evaluated tiles of a level.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/candidates.hpp"
#include "engine/levels/level.hpp"
#include "engine/results/orientation_graph.hpp"
#include "engine/results/point_results.hpp"
#include "engine/results/probability_voxels.hpp"
#include "engine/results/scan_sample.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace lacuna {

// The method, which finds the loops. Of the first level, also all else that a user wants of its points.
struct Consumers {
  Consumers(const Level& level, const Job& job);

  std::unique_ptr<BoundaryMethod> boundary;
  std::optional<Candidates> candidates;  // of the first level
  std::optional<PointResults> points;
  std::optional<ProbabilityVoxels> voxels;
  std::optional<ScanSample> sample;
  std::optional<OrientationGraph> orientation;

  std::vector<TileConsumer*> all;
};

}  // namespace lacuna
