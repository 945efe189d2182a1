// SPDX-License-Identifier: Apache-2.0
// Entwine's point tiles: a folder of LAZ files with a hierarchy that counts their points.
// https://entwine.io/en/latest/entwine-point-tile.html
#pragma once

#include "engine/run/error.hpp"
#include "io/read/rows/scan_reader.hpp"

#include <filesystem>

namespace lacuna::io {

// A hierarchy that does not fit in memory. Its tiles cannot be read without it.
struct TooManyTiles : Error {
  using Error::Error;
};

// Returns the ept.json that a name stands for: itself, or the one in a folder. Empty if there is none.
std::filesystem::path find_ept(const std::filesystem::path& input);

// Returns the folder of the tiles. Throws `Error` if they are no LAZ files.
std::filesystem::path ept_data(const std::filesystem::path& ept);

// Throws `Error` unless the tiles are those of the hierarchy, which may have several files. Their points must
// add up to the number in ept.json, and a tile must have as many as the hierarchy counts. The function opens
// each tile once. Memory: about 100 bytes for each tile of the hierarchy, within that of the options.
void check_ept(const std::filesystem::path& ept, const ReadOptions& options);

}  // namespace lacuna::io
