// SPDX-License-Identifier: Apache-2.0
// Fills a tile store: bucket, and the thinning of levels, make all stores in this way.
#pragma once

#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// Empty files for a store.
struct StoreFiles {
  StoreFile points, normals;
  Spill spill;  // for the duplicates
};

// Tiles are reserved in order, and put in any order.
class StoreWriter {
 public:
  // `most_tiles`: no more are reserved.
  StoreWriter(StoreFiles files, std::uint64_t most_tiles, Precision precision, bool with_normals);

  bool with_normals() const { return with_normals_; }

  // Reserves rows for a tile of at most so many distinct points. Throws `Error` where no tile is left. One
  // thread calls it, while no other uses the writer.
  TileIndex reserve(std::uint64_t points);
  // Returns the tile that is reserved next.
  TileIndex next_tile() const { return static_cast<TileIndex>(tiling_.tiles.size()); }

  // Puts the distinct points of a tile, in the order of its cells. It sets the rows of the cells. Throws
  // `Error` where there are more points than reserved. From several threads, for different tiles.
  void put(TileIndex tile, std::span<const ScanPoint> points, std::span<const PlainNormal> normals,
           std::vector<Cell> cells);
  // Adds copies of a tile's points, once or in several goes, also of the next tile. From any thread.
  void add_duplicates(TileIndex tile, std::span<const Duplicate> duplicates) {
    duplicates_.append(tile, duplicates);
  }

  // Returns the store, once all reserved tiles are put. The writer is empty then.
  TileStore finish();

 private:
  StoreColumns columns_;
  bool with_normals_;
  Tiling tiling_;
  std::vector<std::vector<Cell>> cells_;  // of each tile
  AppendLists<Duplicate> duplicates_;
};

}  // namespace lacuna
