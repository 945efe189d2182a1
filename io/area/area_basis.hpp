// SPDX-License-Identifier: Apache-2.0
// What the figures of a check of an area rest on.
#pragma once

#include "io/area/check_area.hpp"

#include <vector>

namespace lacuna::io {

// Returns a line for each thing that decides what a figure is of: area, returns, classes, swaths, points.
std::vector<BasisLine> basis_of(const AreaCheck& check, const ScanFiles& scan, const FilesConfig& config);

}  // namespace lacuna::io
