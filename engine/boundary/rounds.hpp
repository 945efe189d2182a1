// SPDX-License-Identifier: Apache-2.0
// Rounds over tiles. They repeat until nothing changes.
#pragma once

#include "engine/model/tiling.hpp"

#include <cstddef>
#include <mutex>
#include <numeric>
#include <set>
#include <span>
#include <vector>

namespace lacuna {

// The first round has all tiles. Each further round has the tiles that were requested in the round before.
class Rounds {
 public:
  explicit Rounds(std::size_t tiles) : tiles_(tiles) {
    std::iota(tiles_.begin(), tiles_.end(), TileIndex{0});
  }

  std::span<const TileIndex> tiles() const { return tiles_; }  // empty: there are no more rounds

  // From any thread.
  void request(std::span<const TileIndex> tiles) {
    const std::lock_guard lock(mutex_);
    requested_.insert(tiles.begin(), tiles.end());
  }
  void next() {
    tiles_.assign(requested_.begin(), requested_.end());
    requested_.clear();
  }

 private:
  std::vector<TileIndex> tiles_;
  std::mutex mutex_;
  std::set<TileIndex> requested_;
};

}  // namespace lacuna
