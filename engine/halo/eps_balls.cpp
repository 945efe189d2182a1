// SPDX-License-Identifier: Apache-2.0
#include "engine/halo/eps_balls.hpp"

#include "engine/model/distance_bound.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/run/error.hpp"

#include <atomic>
#include <cmath>
#include <sstream>

namespace lacuna {

double extent_of(const Eigen::AlignedBox3d& bounds) {
  return bounds.isEmpty() ? 0 : std::sqrt(squared_distance(bounds.max(), bounds.min()));
}

double eps_length(const NeighbourhoodConfig& config, double extent) {
  return config.eps > 0 ? config.eps : config.eps_fraction * extent;
}

std::uint64_t ball_bytes(const Tiling& tiling, const Tile& tile, double eps, std::uint64_t most) {
  // A neighbour is in the list of its ball and in the neighbourhood.
  constexpr std::uint64_t kBytes = 2 * sizeof(LocalIndex);
  std::uint64_t bytes = 0;
  if (eps == 0) return bytes;
  for (std::uint32_t cell = tile.first_cell; cell < tile.last_cell && bytes <= most; ++cell) {
    const std::uint64_t queries = tiling.cells[cell].points;
    for_each_cell_near(tiling, tiling.cells[cell].box, eps * eps, 0, 0, [&](std::uint32_t near) {
      bytes += kBytes * queries * tiling.cells[near].points;
      return bytes <= most;
    });
  }
  return bytes;
}

// Such a tile is alone at work, and the bound is about twice the memory that it takes.
std::uint64_t most_ball_bytes(const Memory& memory) {
  return 2 * memory.tiles;
}

void refuse_balls(const Tiling& tiling, double eps, const Workers& workers) {
  if (eps == 0) return;
  const std::uint64_t most = most_ball_bytes(workers.memory);
  std::atomic<bool> fits = true;
  workers.arena.for_each(tiling.tiles.size(), [&](std::size_t t) {
    if (fits && ball_bytes(tiling, tiling.tiles[t], eps, most) > most) fits = false;
  });
  if (fits) return;
  std::ostringstream message;
  message << "eps of " << eps << ": the points within it of one tile's points may take more than "
          << print_bytes(most) << ", which is what memory_limit " << print_bytes(workers.memory.limit)
          << " leaves for them; allowed: a smaller eps, smaller tile_points or a larger memory_limit";
  throw Error(message.str());
}

}  // namespace lacuna
