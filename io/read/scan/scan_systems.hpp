// SPDX-License-Identifier: Apache-2.0
// The coordinate reference systems and units of length of the files of a scan.
#pragma once

#include "io/read/scan/scan_files.hpp"

#include <vector>

namespace lacuna::io {

// Completes what each file states of its units, and chooses how z is brought into the unit of x and y. A
// system states the units that a file does not, or contradicts them. Returns what holds for all. Throws
// `Error` if z has a stated unit, and x and y have none.
CommonSystem choose_systems(const InputConfig& config, const StatedCrs& stated, std::vector<ScanFile>& files);

}  // namespace lacuna::io
