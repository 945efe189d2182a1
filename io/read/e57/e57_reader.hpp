// SPDX-License-Identifier: Apache-2.0
// E57: the points of all scans of a file, moved by their poses. ASTM E2807-11.
//
// Every record is a row. Rays without a return have no position (NaN): those marked as invalid, and those
// that end at the scanner itself. e57_columns.hpp lists the columns. Images, blobs and bounds are passed
// over.
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <filesystem>
#include <memory>

namespace lacuna::io {

bool looks_like_e57(const FileStart& start);

// Read front to back in bounded memory: a few MiB, what the scans are, and the batch. Only pages that are
// read have their checksums checked. Flags of packets are ignored, as libE57Format does. Cost: linear. A
// point of three floats takes about 10 ns, half of them for the checksums; a spherical one takes 50 ns.
std::unique_ptr<ScanReader> open_e57(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace lacuna::io
