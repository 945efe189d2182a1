// SPDX-License-Identifier: Apache-2.0
// PCD, the point clouds of PCL: ASCII, binary and compressed, versions .5 to .7.
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_pcd(const FileStart& start);

// Every field becomes properties: `a` of COUNT 3 becomes a_0 a_1 a_2. Integers of 8 bytes become doubles, so
// that values above 2^53 are rounded. normal_x normal_y normal_z become nx ny nz. The packed colours `rgb`
// and `rgba` become the bytes red green blue and alpha. Fields named `_` are padding and left out. VIEWPOINT
// is a place of rays without return; coordinates stay as they are. Points that are NaN are rows like any
// others. A file too short for its header is an `Error`. So is a file with more data behind its rows, apart
// from zeros in a binary file. A compressed file stores each field for all points, one field after the other.
// It is unpacked twice, by one stream for each field, at most 256 of them. Memory besides the batch: 70 KiB a
// field, whatever the number of points.
std::unique_ptr<ScanReader> open_pcd(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
