// SPDX-License-Identifier: Apache-2.0
// What a run takes, found by its first steps and a sample of the others.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/detection.hpp"
#include "engine/model/points.hpp"
#include "engine/run/progress.hpp"
#include "engine/run_needs.hpp"

#include <cstdint>
#include <filesystem>

namespace lacuna {

struct Estimate {
  Summary summary;  // points, dropped, bounds, resolution, tiles, threads, memory limit, phases
  DiskNeeds disk;
  std::uint64_t memory = 0;  // bytes at the peak
  double seconds = 0;        // until the results are there to be written
  double slowdown = 1;       // seconds for a second of processor time, by what else the machine does now
  double density = 0;  // distinct points of the first level per square unit of the surface; 0: not known
  double cell_size = 0;
  std::uint64_t cells = 0;
};

// The scan is surveyed, thinned and bucketed as in the run itself; the time of that is measured. The other
// steps run on a sample of at most 160,000 points. `workspace`: an existing empty folder. Throws `Error`.
Estimate estimate(PointSource& scan, const Config& config, const std::filesystem::path& workspace,
                  Progress& progress);

}  // namespace lacuna
