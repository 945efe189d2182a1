// SPDX-License-Identifier: Apache-2.0
// Coordinates of the PLY and PCD files of a run: those of the scan, or with --local-coordinates floats
// relative to an offset.
#pragma once

#include "engine/model/detection.hpp"
#include "io/options/options.hpp"
#include "io/rows/local_offset.hpp"
#include "io/scan/file_scan.hpp"

#include <vector>

namespace lacuna::io {

// The middle of the bounds of the scan without its strays, in whole units; 0 0 0 without points. It depends
// on the scan alone. None without --local-coordinates. Floats then keep 2^-24 of the extent around it.
LocalOffset local_offset(const Detection& detection, const OutputConfig& config);

// The type of the coordinates of vertices.
Scalar coordinate_type(const FileScan& scan, const OutputConfig& config);

// The columns of the scan's files as they are written: with --local-coordinates, x y z are floats.
std::vector<RowLayout> written_layouts(const FileScan& scan, const OutputConfig& config);

}  // namespace lacuna::io
