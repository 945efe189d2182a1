// SPDX-License-Identifier: Apache-2.0
// A scan moved to its place in the registered scan.
#pragma once

#include "io/rows/pose.hpp"
#include "io/rows/scan_reader.hpp"

#include <memory>

namespace lacuna::io {

// Returns the rows of `reader` with their positions moved by the pose, and their normals turned. Positions
// and normals become doubles; all else stays as it is.
std::unique_ptr<ScanReader> posed(std::unique_ptr<ScanReader> reader, const Pose& pose);

// Returns the rows of `reader` with z in another unit, a multiple of it. Normals stay at right angles to the
// surface, but need not have unit length.
std::unique_ptr<ScanReader> with_z_times(std::unique_ptr<ScanReader> reader, double factor);

}  // namespace lacuna::io
