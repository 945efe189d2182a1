// SPDX-License-Identifier: Apache-2.0
// The consumers of evaluated tiles: each adds its records to the output of the tile.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/config/job.hpp"
#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/results/scan_sample.hpp"
#include "engine/thin/level.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace lacuna {

// The method finds the loops. At the first level, other consumers find all else that a user wants of its
// points.
struct Consumers {
  Consumers(const Level& level, const Job& job);  // both must outlive this
  Consumers(const Consumers&) = delete;
  Consumers& operator=(const Consumers&) = delete;

  std::unique_ptr<BoundaryMethod> method;
  std::optional<ScanSample> sample;

  std::vector<TileConsumer> all;
};

}  // namespace lacuna
