// SPDX-License-Identifier: Apache-2.0
// Coordinates of the PLY files of a run: the scan's, or with --local-coordinates floats relative to an
// offset.
#pragma once

#include "engine/model/detection.hpp"
#include "io/read/options/options.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/scan/scan_files.hpp"

#include <vector>

namespace lacuna::io {

// Returns the middle of the bounds of the scan without its strays, in whole units; 0 0 0 without points. It
// depends on the scan alone. Without --local-coordinates there is no offset. With it, floats keep 2^-24 of
// the extent around the offset.
LocalOffset local_offset(const Detection& detection, const OutputConfig& config);

// Returns the type of the coordinates of vertices.
Scalar coordinate_type(const ScanFiles& scan, const OutputConfig& config);

// Returns the columns of the scan's files as a run writes them: with --local-coordinates, x y z are floats.
std::vector<RowLayout> written_layouts(const ScanFiles& scan, const OutputConfig& config);

}  // namespace lacuna::io
