// SPDX-License-Identifier: Apache-2.0
// LAS 1.0 to 1.5, point formats 0 to 10 (ASPRS LAS specification 1.4 R15).
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_las(const FileStart& start);

// Coordinates are stored * scale + offset, in double precision. Every field of the point format and the extra
// bytes are columns. Extended records behind the points are passed over. A file that is too short for the
// points that its header declares is an `Error` at once.
std::unique_ptr<ScanReader> open_las(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
