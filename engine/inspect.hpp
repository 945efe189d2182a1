// SPDX-License-Identifier: Apache-2.0
// The first steps of a run alone. They find what is known of a scan once its points are counted.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/detection.hpp"
#include "engine/model/points.hpp"
#include "engine/run/progress.hpp"

#include <cstdint>
#include <filesystem>

namespace lacuna {

struct Inspection {
  Summary summary;  // points, dropped, bounds, strays, resolution, tiles, threads, memory limit
  double cell_size = 0;
  std::uint64_t cells = 0;
};

// Surveys, thins and buckets the scan as a run does. `temporary`: an existing empty folder. Throws `Error`,
// also where the scan can never fit in the memory limit.
Inspection inspect(PointSource& scan, const Config& config, const std::filesystem::path& temporary,
                   Progress& progress);

}  // namespace lacuna
