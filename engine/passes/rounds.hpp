// Tiles to look at, again and again until nothing changes.
#pragma once

#include "engine/data/tiling.hpp"

#include <cstddef>
#include <mutex>
#include <numeric>
#include <set>
#include <span>
#include <vector>

namespace lacuna {

// In the first round all tiles; in each further one those that were asked for in the one before.
class Rounds {
 public:
  explicit Rounds(std::size_t tiles) : tiles_(tiles) {
    std::iota(tiles_.begin(), tiles_.end(), TileIndex{0});
  }

  std::span<const TileIndex> tiles() const { return tiles_; }  // none: there are no more rounds

  // From any thread.
  void ask_for(std::span<const TileIndex> tiles) {
    const std::lock_guard lock(mutex_);
    asked_.insert(tiles.begin(), tiles.end());
  }
  void next() {
    tiles_.assign(asked_.begin(), asked_.end());
    asked_.clear();
  }

 private:
  std::vector<TileIndex> tiles_;
  std::mutex mutex_;
  std::set<TileIndex> asked_;
};

}  // namespace lacuna
