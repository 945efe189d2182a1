// SPDX-License-Identifier: Apache-2.0
// The tile store: every distinct point of the scan on disk, in cell order. So one read loads a tile, and a
// few reads load the cells around it. Bucket, and the thinning of levels, fill it by a `StoreWriter`.
#pragma once

#include "engine/model/tiling.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/store/digest.hpp"
#include "engine/store/point_column.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

using PlainNormal = std::array<double, 3>;

// A point at the coordinates of another point of its tile. The other point has a lower id and represents it.
struct Duplicate {
  PointId id;
  LocalIndex of;
  std::uint32_t padding = 0;  // all bytes are in the checksum of a part
};

// The digests of a tile's points and normals, as the files have them.
struct TileDigests {
  Digest points, normals;
};

// The points and normals of a run of rows, in files.
struct StoreColumns {
  PointColumn points;
  Column<PlainNormal> normals;
  std::uint64_t first_row = 0;
};

// Reads may come from several threads. `StoreWriter` makes a store.
class TileStore {
 public:
  // `digests`: of each tile of a store that was finished before; none of a new one. Reading a tile throws
  // `DamagedFile` where its bytes have other digests.
  TileStore(StoreColumns columns, bool with_normals, Tiling tiling, AppendLists<Duplicate> duplicates,
            std::vector<TileDigests> digests = {});
  // Joins stores of the same kind, at least one, of all of which the digests are known, or of none. Tiles of
  // the first one come first.
  static TileStore joined(std::vector<TileStore> parts, const Spill& spill);

  const Tiling& tiling() const { return tiling_; }
  bool has_normals() const { return has_normals_; }
  // From now on the store is one of points without normals.
  void leave_out_normals() { has_normals_ = false; }

  std::vector<ScanPoint> points(TileIndex tile) const;
  // Goes through the points without an array of them: visit(point).
  template <class Visit>
  void for_each_point(TileIndex tile, Visit&& visit) const;
  std::vector<Eigen::Vector3d> normals(TileIndex tile) const;  // as given; empty where none are
  // visit(duplicate) for each, in any order: there may be more than fit in memory.
  template <class Visit>
  void for_each_duplicate(TileIndex tile, Visit&& visit) const {
    duplicates_.for_each(tile, visit);
  }
  std::vector<ScanPoint> cell(std::uint32_t cell) const;

  // Reads the points of the cells and their rows. The cells ascend and do not repeat.
  void read_cells(std::span<const std::uint32_t> cells, std::vector<ScanPoint>& points,
                  std::vector<Row>& rows) const;

  Precision precision() const { return columns_.front().points.precision(); }
  // Return the digests and the files for sealing, where the store is not joined of others.
  TileDigests digests(TileIndex tile) const;
  StoreFile& points_file() { return columns_.front().points.file(); }
  StoreFile& normals_file() { return columns_.front().normals.file(); }

 private:
  const StoreColumns& columns_of(std::uint64_t row) const;
  void read_points(std::uint64_t row, std::span<ScanPoint> points) const;
  std::vector<ScanPoint> read_points(std::uint64_t row, std::uint64_t count) const;
  // Checks a tile before it is read for the first time.
  void check(TileIndex tile) const {
    if (is_checked_.empty()) return;
    if (std::atomic_ref(is_checked_[tile]).load(std::memory_order_relaxed) == 0) check_digests(tile);
  }
  void check_digests(TileIndex tile) const;

  Tiling tiling_;
  bool has_normals_;
  bool stores_normals_;                // also where they are left out
  std::vector<StoreColumns> columns_;  // in ascending row
  AppendLists<Duplicate> duplicates_;
  std::vector<TileDigests> digests_;              // of a store that was finished before
  mutable std::vector<std::uint8_t> is_checked_;  // of each of these tiles
};

template <class Visit>
void TileStore::for_each_point(TileIndex index, Visit&& visit) const {
  check(index);
  const Tile& tile = tiling_.tiles[index];
  std::array<ScanPoint, 2048> part;
  for (std::uint64_t done = 0; done < tile.points;) {
    const std::uint64_t count = std::min<std::uint64_t>(part.size(), tile.points - done);
    read_points(value(tile.first_row) + done, std::span(part).first(count));
    for (std::size_t i = 0; i < count; ++i) visit(part[i]);
    done += count;
  }
}

// Empty files for a store.
struct StoreFiles {
  StoreFile points, normals;
  Spill spill;  // for the duplicates
};

// Fills a tile store: bucket, and the thinning of levels, make all stores in this way. Tiles are reserved in
// order, and put in any order.
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
