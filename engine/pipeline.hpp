// SPDX-License-Identifier: Apache-2.0
// The whole method, from a scan to its holes, in bounded memory.
#pragma once

#include "engine/config/config.hpp"
#include "engine/export.hpp"
#include "engine/model/detection.hpp"
#include "engine/model/points.hpp"
#include "engine/run/progress.hpp"

#include <filesystem>
#include <memory>

namespace lacuna {

// Finds the boundary probability of every point and the loops around every hole of `scan`. Data that does not
// fit in memory goes to `scratch`, an existing empty folder that must outlive the result. An empty path
// stands for files in memory. Throws `Error`, and what `progress` throws. The result is the same, bit for
// bit, for every `config.run`.
//
// The config may name a workspace, an existing folder. Then finished steps are kept there. A later call with
// the same input and parameters goes on from them (workspace/workspace.hpp).
LACUNA_API std::unique_ptr<Detection> detect(PointSource& scan, const Config& config,
                                             const std::filesystem::path& scratch, Progress& progress);

}  // namespace lacuna
