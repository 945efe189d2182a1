// SPDX-License-Identifier: Apache-2.0
#include "engine/store/tile_store.hpp"

#include "engine/run/error.hpp"
#include "engine/store/sealed_part.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <utility>

namespace lacuna {
namespace {

constexpr const char* kOtherPoints = "not the points that were counted";

}  // namespace

TileStore::TileStore(StoreColumns columns, bool with_normals, Tiling tiling,
                     AppendLists<Duplicate> duplicates, std::vector<TileDigests> digests)
    : tiling_(std::move(tiling)),
      has_normals_(with_normals),
      stores_normals_(with_normals),
      duplicates_(std::move(duplicates)),
      digests_(std::move(digests)),
      is_checked_(digests_.size()) {
  columns_.push_back(std::move(columns));
  assert(tiling_.check());
}

TileStore TileStore::joined(std::vector<TileStore> parts, const Spill& spill) {
  std::size_t tiles = 0, cells = 0;
  for (const TileStore& part : parts) {
    tiles += part.tiling_.tiles.size();
    cells += part.tiling_.cells.size();
  }
  TileStore& all = parts.front();
  all.tiling_.tiles.reserve(tiles);
  all.tiling_.cells.reserve(cells);
  AppendLists<Duplicate> all_duplicates(spill, "duplicates", tiles);
  for (TileStore& part : parts) {
    const std::size_t first_tile = &part == &all ? 0 : all.tiling_.tiles.size();
    for (std::size_t t = 0; t < part.tiling_.tiles.size(); ++t)
      part.duplicates_.for_each(t, [&](const Duplicate& d) { all_duplicates.append(first_tile + t, d); });
    if (&part == &all) continue;
    const auto first_cell = static_cast<std::uint32_t>(all.tiling_.cells.size());
    const std::uint64_t first_row = aligned_row(all.tiling_.row_count());
    for (Tile tile : part.tiling_.tiles) {
      tile.first_cell += first_cell;
      tile.last_cell += first_cell;
      tile.first_row = Row{value(tile.first_row) + first_row};
      all.tiling_.tiles.push_back(tile);
    }
    for (Cell cell : part.tiling_.cells) {
      cell.first_row = Row{value(cell.first_row) + first_row};
      all.tiling_.cells.push_back(cell);
    }
    part.columns_.front().first_row = first_row;
    all.columns_.push_back(std::move(part.columns_.front()));
    all.digests_.insert(all.digests_.end(), part.digests_.begin(), part.digests_.end());
  }
  all.duplicates_ = std::move(all_duplicates);
  all.is_checked_.assign(all.digests_.size(), 0);
  all.tiling_.build_tree();
  assert(all.tiling_.check());
  return std::move(all);
}

const StoreColumns& TileStore::columns_of(std::uint64_t row) const {
  const auto lies_before = [](std::uint64_t at, const StoreColumns& columns) {
    return at < columns.first_row;
  };
  return *std::prev(std::upper_bound(columns_.begin(), columns_.end(), row, lies_before));
}

void TileStore::read_points(std::uint64_t row, std::span<ScanPoint> points) const {
  const StoreColumns& columns = columns_of(row);
  columns.points.read(row - columns.first_row, points);
}

std::vector<ScanPoint> TileStore::read_points(std::uint64_t row, std::uint64_t count) const {
  std::vector<ScanPoint> points(count);
  read_points(row, points);
  return points;
}

TileDigests TileStore::digests(TileIndex index) const {
  const Tile& tile = tiling_.tiles[index];
  const StoreColumns& columns = columns_of(value(tile.first_row));
  const std::uint64_t row = value(tile.first_row) - columns.first_row;
  return {columns.points.digest(row, tile.points),
          columns.normals.digest(row, stores_normals_ ? tile.points : 0)};
}

// Several threads may check a tile at once. They find the same.
void TileStore::check_digests(TileIndex tile) const {
  const TileDigests found = digests(tile);
  const StoreColumns& columns = columns_of(value(tiling_.tiles[tile].first_row));
  if (found.points != digests_[tile].points) throw DamagedFile(columns.points.file().path());
  if (found.normals != digests_[tile].normals) throw DamagedFile(columns.normals.file().path());
  std::atomic_ref(is_checked_[tile]).store(1, std::memory_order_relaxed);
}

std::vector<ScanPoint> TileStore::points(TileIndex index) const {
  check(index);
  const Tile& tile = tiling_.tiles[index];
  return read_points(value(tile.first_row), tile.points);
}

std::vector<Eigen::Vector3d> TileStore::normals(TileIndex index) const {
  std::vector<Eigen::Vector3d> normals;
  if (!has_normals_) return normals;
  check(index);
  const Tile& tile = tiling_.tiles[index];
  const StoreColumns& columns = columns_of(value(tile.first_row));
  for (const PlainNormal& n : columns.normals.read(value(tile.first_row) - columns.first_row, tile.points))
    normals.emplace_back(n.data());
  return normals;
}

std::vector<ScanPoint> TileStore::cell(std::uint32_t cell) const {
  check(tiling_.tile_of_cell(cell));
  return read_points(value(tiling_.cells[cell].first_row), tiling_.cells[cell].points);
}

void TileStore::read_cells(std::span<const std::uint32_t> cells, std::vector<ScanPoint>& points,
                           std::vector<Row>& rows) const {
  points.clear();
  rows.clear();
  for (std::size_t i = 0; i < cells.size();) {
    // Cells of a tile whose points follow each other in the store are one read.
    const TileIndex tile = tiling_.tile_of_cell(cells[i]);
    check(tile);
    const std::uint64_t first = value(tiling_.cells[cells[i]].first_row);
    std::uint64_t end = first;
    for (; i < cells.size() && cells[i] < tiling_.tiles[tile].last_cell &&
           value(tiling_.cells[cells[i]].first_row) == end;
         ++i)
      end += tiling_.cells[cells[i]].points;
    const std::size_t at = points.size();
    points.resize(at + (end - first));
    read_points(first, std::span(points).subspan(at));
    for (std::uint64_t row = first; row < end; ++row) rows.push_back(Row{row});
  }
}

StoreWriter::StoreWriter(StoreFiles files, std::uint64_t most_tiles, Precision precision, bool with_normals)
    : columns_{PointColumn(std::move(files.points), precision),
               Column<PlainNormal>(std::move(files.normals))},
      with_normals_(with_normals),
      duplicates_(files.spill, "duplicates", most_tiles) {}

TileIndex StoreWriter::reserve(std::uint64_t points) {
  const TileIndex tile = next_tile();
  if (tile >= duplicates_.lists()) fail_changed(kOtherPoints);
  const std::uint64_t row =
      tile == 0 ? 0 : aligned_row(value(tiling_.tiles.back().first_row) + tiling_.tiles.back().raw);
  tiling_.tiles.push_back({.first_row = Row{row}, .raw = points});
  cells_.emplace_back();
  return tile;
}

void StoreWriter::put(TileIndex index, std::span<const ScanPoint> points,
                      std::span<const PlainNormal> normals, std::vector<Cell> cells) {
  Tile& tile = tiling_.tiles[index];
  if (points.size() > tile.raw)  // its rows would run into the next tile's
    fail_changed(kOtherPoints);
  tile.points = points.size();
  std::uint64_t row = value(tile.first_row);
  for (Cell& cell : cells) {
    cell.first_row = Row{row};
    row += cell.points;
  }
  cells_[index] = std::move(cells);
  columns_.points.write(value(tile.first_row), points);
  if (with_normals_) columns_.normals.write(value(tile.first_row), normals);
}

TileStore StoreWriter::finish() {
  std::size_t count = 0;
  for (const std::vector<Cell>& cells : cells_) count += cells.size();
  tiling_.cells.reserve(count);
  for (std::size_t t = 0; t < cells_.size(); ++t) {
    Tile& tile = tiling_.tiles[t];
    tile.first_cell = static_cast<std::uint32_t>(tiling_.cells.size());
    tiling_.cells.insert(tiling_.cells.end(), cells_[t].begin(), cells_[t].end());
    tile.last_cell = static_cast<std::uint32_t>(tiling_.cells.size());
    std::vector<Cell>().swap(cells_[t]);
  }
  tiling_.build_tree();
  return {std::move(columns_), with_normals_, std::move(tiling_), std::move(duplicates_)};
}

}  // namespace lacuna
