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

}  // namespace lacuna
