// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/tile_size.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace lacuna {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

// A tile at work takes these bytes, whatever its points.
constexpr std::uint64_t kTileBytes = kMiB / 4;

// Stored point, position, id, row, tree, evaluation, edges, outputs; k neighbours in two lists.
std::uint64_t bytes_per_tile_point(const Config& config) {
  return 420 + 12 * static_cast<std::uint64_t>(config.neighbourhood.k) + (config.normals.orient ? 80 : 0);
}

// The limits of the points of a tile. With fewer, the tables with entries for every tile do not fit in
// memory. With more, a tile does not fit, or its neighbours cannot be numbered in 32 bits.
struct TileSizes {
  std::uint64_t least, most;
};

TileSizes tile_sizes(const Memory& memory, std::uint64_t points, const Config& config) {
  constexpr std::uint64_t kTables = 1 << 10;  // bytes for each tile, in all tables that exist at a time
  const std::uint64_t neighbours =
      2 * static_cast<std::uint64_t>(config.neighbourhood.k);  // of a point, on average at most
  return {.least = points / (memory.lists / kTables) + 1,
          .most = std::min((memory.tiles - kTileBytes) / bytes_per_tile_point(config),
                           std::numeric_limits<std::uint32_t>::max() / neighbours)};
}

}  // namespace

std::uint64_t tile_bytes(std::uint64_t points, const Config& config) {
  return points * bytes_per_tile_point(config) + kTileBytes;
}

std::uint64_t points_per_tile(std::uint64_t points, const Config& config, const Workers& workers) {
  constexpr std::uint64_t kLeast = 4096;        // smaller ones are mostly border
  constexpr std::uint64_t kMost = 256 << 10;    // larger ones gain little
  constexpr std::uint64_t kTilesPerThread = 2;  // so that the last tiles do not leave threads idle
  const Memory& memory = workers.memory;
  TileSizes sizes = tile_sizes(memory, points, config);
  if (sizes.least > sizes.most) {
    std::uint64_t limit = memory.limit / kMiB * kMiB;
    while (sizes.least > sizes.most) sizes = tile_sizes(Memory::share(limit += kMiB), points, config);
    throw Error("the memory limit of " + std::to_string(memory.limit / kMiB) + " MiB is too small for " +
                std::to_string(points) + " points; allowed: " + std::to_string(limit / kMiB) + "MiB or more");
  }
  if (config.run.tile_points > 0)
    return std::clamp(static_cast<std::uint64_t>(config.run.tile_points), sizes.least, sizes.most);
  // Halves are not quite equal: without space for the larger ones some would be halved once more.
  const std::uint64_t threads = workers.arena.threads(), even = points * 9 / 8 / (kTilesPerThread * threads);
  // Without the fixed bytes of each further tile: tiles are rarely full, and `for_each_within_budget` holds
  // the budget. Smaller tiles cost more time: within 64 MiB, 16 threads took 17 % longer with them counted.
  const std::uint64_t wanted = std::min(std::clamp(even, kLeast, kMost), sizes.most / threads);
  return std::max(wanted, sizes.least);
}

std::uint64_t points_per_cell(std::uint64_t points, const Memory& memory) {
  constexpr std::uint64_t kFew = 32;
  constexpr std::uint64_t kBytesPerCell = 128;  // with its share of the tree
  // Cuts leave cells about half full.
  return std::max(kFew, 2 * points * kBytesPerCell / memory.cells);
}

}  // namespace lacuna
