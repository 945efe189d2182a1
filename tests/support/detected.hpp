// SPDX-License-Identifier: Apache-2.0
// A finished run of the engine, all of it in memory, to be compared.
#pragma once

#include "engine/pipeline.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/test.hpp"

namespace lacuna {

struct Detected {
  Summary summary;
  std::vector<PointResult> points;  // one per row of the input
  std::vector<BoundaryPoint> boundary;
  std::vector<ReportedLoop> loops;

  std::vector<std::vector<PointId>> loop_ids() const;
  // Every byte of the result that must not depend on the tiling.
  std::string bytes() const;
};

// Runs the engine in a workspace of its own, with results.points.
Detected run_engine(const Cloud& cloud, Config config);
Detected run_engine(PointSource& scan, Config config);
Detected run_engine(PointSource& scan, Config config, Progress& progress);

}  // namespace lacuna
