// SPDX-License-Identifier: Apache-2.0
// `lacuna info`: what scan files hold, and what a run on them would take.
#pragma once

#include "io/read/options/options.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace lacuna::tools {

// Returns what `lacuna info --json` prints. Its warnings take the place of `warnings`. Throws `Error`.
std::string info_json(const std::vector<std::filesystem::path>& scans, const io::FilesConfig& config,
                      std::vector<std::string>& warnings);

}  // namespace lacuna::tools
