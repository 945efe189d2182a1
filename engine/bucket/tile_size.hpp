// SPDX-License-Identifier: Apache-2.0
// How many points tiles and cells have, and the memory that they take.
#pragma once

#include "engine/config/config.hpp"
#include "engine/run/parallel.hpp"

#include <cstdint>

namespace lacuna {

// Returns the points per tile: as the config has it, or enough tiles for all threads. They are never fewer
// or more than memory allows. Throws `Error` where so many points can never fit.
std::uint64_t points_per_tile(std::uint64_t points, const Config& config, const Workers& workers);
// Returns the points in a cell of the index, so that all cells fit in memory.
std::uint64_t points_per_cell(std::uint64_t points, const Memory& memory);
// Returns the bytes that a tile with so many points takes while it is evaluated.
std::uint64_t tile_bytes(std::uint64_t points, const Config& config);

}  // namespace lacuna
