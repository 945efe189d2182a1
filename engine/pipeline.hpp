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
// fit in memory goes to `temporary`, an existing empty folder that must outlive the result. Throws `Error`,
// and what `progress` throws. The result is the same, bit for bit, for every `config.run`.
//
// The config may name an existing folder that is kept. Then parts of finished steps stay there. A later call
// makes again only what differs (parts/parts.hpp).
LACUNA_API std::unique_ptr<Detection> detect(PointSource& scan, const Config& config,
                                             const std::filesystem::path& temporary, Progress& progress);

}  // namespace lacuna
