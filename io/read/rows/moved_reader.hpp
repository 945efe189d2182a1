// SPDX-License-Identifier: Apache-2.0
// A file with coordinates of its own, read in the coordinates of the scan.
#pragma once

#include "io/read/rows/local_offset.hpp"
#include "io/read/rows/pose.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <memory>

namespace lacuna::io {

// Returns the rows of `reader`, a PLY file, with the offset added to their positions, which become doubles.
// Places of scanners have the offset already. Returns `reader` itself without an offset.
std::unique_ptr<ScanReader> with_offset(std::unique_ptr<ScanReader> reader, const LocalOffset& offset);

// Returns the rows of `reader` with their positions moved by the pose, and their normals turned. Positions
// and normals become doubles; all else stays as it is.
std::unique_ptr<ScanReader> posed(std::unique_ptr<ScanReader> reader, const Pose& pose);

// Returns the rows of `reader` with z in another unit, a multiple of it. Normals stay at right angles to the
// surface, but need not have unit length.
std::unique_ptr<ScanReader> with_z_times(std::unique_ptr<ScanReader> reader, double factor);

}  // namespace lacuna::io
