// SPDX-License-Identifier: Apache-2.0
// PTX: scans of Leica and others as text, each with its grid of rays and its pose.
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

// Whether the file begins with two bare counts, then three numbers.
bool looks_like_ptx(const FileStart& start);

// Blocks come one after the other. A block has the columns and rows of the grid, the place and axes of the
// scanner, and a 4 x 4 matrix. Then it has one line for each ray. A line is x y z intensity, or x y z
// intensity red green blue. The matrix is applied, so all blocks are in the same coordinates. It must be a
// pose (io/read/rows/pose.hpp). Rays without a return, 0 0 0, have coordinates that are not numbers: they stay
// rows, and the engine drops and counts them. Columns: x y z intensity (red green blue) scan, the number of
// the block.
std::unique_ptr<ScanReader> open_ptx(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
