// SPDX-License-Identifier: Apache-2.0
// Entwine's point tiles: a folder of LAZ files, and an ept.json that counts their points.
// https://entwine.io/en/latest/entwine-point-tile.html
#pragma once

#include "io/read/rows/scan_reader.hpp"

#include <filesystem>

namespace lacuna::io {

// Returns the ept.json that a name stands for: itself, or the one in a folder. Empty if there is none.
std::filesystem::path find_ept(const std::filesystem::path& input);

// Returns the folder of the tiles. Throws `Error` if they are no LAZ files.
std::filesystem::path ept_data(const std::filesystem::path& ept);

// Throws `Error` unless the points of all tiles add up to the number in ept.json, so that no tile is missing.
// Opens each tile once.
void check_ept(const std::filesystem::path& ept, const ReadOptions& options);

}  // namespace lacuna::io
