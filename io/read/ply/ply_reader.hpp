// SPDX-License-Identifier: Apache-2.0
// PLY, ASCII and binary: the points are the rows of element "vertex".
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_ply(const FileStart& start);

// An offset in the header is added to the coordinates, which are then coordinates of the scan. Scalars may
// have any type. Lists and other elements are passed over, but must be complete, and nothing may follow the
// last one. A file too short for its header is an `Error` at once. Its camera is a scanner,
// and a place of rays without return.
std::unique_ptr<ScanReader> open_ply(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
