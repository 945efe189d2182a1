// SPDX-License-Identifier: Apache-2.0
// A file with local coordinates, read in the coordinates of the scan.
#pragma once

#include "io/rows/local_offset.hpp"
#include "io/rows/scan_reader.hpp"

#include <memory>

namespace lacuna::io {

// Returns the rows of `reader`, a PLY or PCD file, with the offset added to their positions, which become
// doubles. Places of scanners have the offset already. Returns `reader` itself without an offset.
std::unique_ptr<ScanReader> with_offset(std::unique_ptr<ScanReader> reader, const LocalOffset& offset);

}  // namespace lacuna::io
