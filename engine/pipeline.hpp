// The whole method, from a scan to its holes, in bounded memory.
#pragma once

#include "engine/config.hpp"
#include "engine/model/detection.hpp"
#include "engine/model/points.hpp"
#include "engine/run/progress.hpp"

#include <filesystem>
#include <memory>

namespace lacuna {

// Finds the boundary probability of every point and the loops around every hole of `scan`. What does not
// fit in memory goes to `workspace`, an existing empty folder that must outlive the result. Throws `Error`.
// The result is the same, bit for bit, for every `config.run`.
std::unique_ptr<Detection> detect(PointSource& scan, const Config& config,
                                  const std::filesystem::path& workspace, Progress& progress);

// What a run would take: the scan is surveyed, bucketed and thinned as in the run itself. `workspace`: as
// above. Throws `Error`.
struct Estimate {
  Summary summary;  // points, dropped, bounds, resolution, tiles, threads, memory limit, phases
  std::uint64_t workspace_bytes = 0;  // of a clean scan; where all is noise up to three times that
  double cell_size = 0;
  std::uint64_t cells = 0;
};
Estimate estimate(PointSource& scan, const Config& config, const std::filesystem::path& workspace,
                  Progress& progress);

// What a run would write to the workspace, from the headers of the scan alone: less than `estimate` says. 0
// where the number of points that count is not known beforehand.
std::uint64_t least_workspace_bytes(const PointSource& scan, const Config& config);

}  // namespace lacuna
