// SPDX-License-Identifier: Apache-2.0
#include "engine/store/tile_store.hpp"

#include "engine/run/error.hpp"

#include <algorithm>
#include <cassert>

namespace lacuna {
namespace {

constexpr const char* kOtherPoints = "not the points that were counted";

std::vector<std::uint64_t> first_rows(const Tiling& tiling) {
  std::vector<std::uint64_t> rows;
  rows.reserve(tiling.tiles.size());
  for (const Tile& tile : tiling.tiles) rows.push_back(value(tile.first_row));
  return rows;
}

}  // namespace

TileStore::TileStore(StoreFiles files, std::vector<Tile> tiles, std::uint64_t most_tiles, Precision precision,
                     bool with_normals, std::shared_ptr<BufferPool> lists)
    : cells_(tiles.size()),
      has_normals_(with_normals),
      points_(std::move(files.points), precision),
      normals_(std::move(files.normals)),
      duplicates_(std::move(files.duplicates), most_tiles, std::move(lists)) {
  tiling_.tiles = std::move(tiles);
}

TileStore::TileStore(StoreFiles files, Tiling tiling, Precision precision, bool with_normals,
                     std::shared_ptr<BufferPool> lists)
    : TileStore(std::move(files), {}, tiling.tiles.size(), precision, with_normals, std::move(lists)) {
  tiling_ = std::move(tiling);
  tiling_.build_tree();
}

std::vector<StoredPoint> TileStore::points(TileIndex index) const {
  const Tile& tile = tiling_.tiles[index];
  return points_.read(value(tile.first_row), tile.points);
}

std::vector<Eigen::Vector3d> TileStore::normals(TileIndex index) const {
  std::vector<Eigen::Vector3d> normals;
  if (!has_normals_) return normals;
  const Tile& tile = tiling_.tiles[index];
  for (const StoredNormal& n : normals_.read(value(tile.first_row), tile.points))
    normals.emplace_back(n.x, n.y, n.z);
  return normals;
}

std::vector<StoredPoint> TileStore::cell(std::uint32_t cell) const {
  return points_.read(value(tiling_.cells[cell].first_row), tiling_.cells[cell].points);
}

void TileStore::read_cells(std::span<const std::uint32_t> cells, std::vector<StoredPoint>& points,
                           std::vector<Row>& rows) const {
  points.clear();
  rows.clear();
  for (std::size_t i = 0; i < cells.size();) {
    // Cells whose points follow each other in the store are one read.
    const std::uint64_t first = value(tiling_.cells[cells[i]].first_row);
    std::uint64_t end = first;
    for (; i < cells.size() && value(tiling_.cells[cells[i]].first_row) == end; ++i)
      end += tiling_.cells[cells[i]].points;
    const std::size_t at = points.size();
    points.resize(at + (end - first));
    points_.read(first, std::span(points).subspan(at));
    for (std::uint64_t row = first; row < end; ++row) rows.push_back(Row{row});
  }
}

std::vector<StoredPoint> TileStore::raw_points(TileIndex index) const {
  const Tile& tile = tiling_.tiles[index];
  return points_.read(value(tile.first_row), tile.raw);
}

std::vector<StoredNormal> TileStore::raw_normals(TileIndex index) const {
  if (!has_normals_) return {};
  const Tile& tile = tiling_.tiles[index];
  return normals_.read(value(tile.first_row), tile.raw);
}

void TileStore::put(TileIndex index, std::span<const StoredPoint> points,
                    std::span<const StoredNormal> normals, std::vector<Cell> cells) {
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
  points_.write(value(tile.first_row), points);
  if (has_normals_) normals_.write(value(tile.first_row), normals);
}

void TileStore::add_tile(std::span<const StoredPoint> points, std::span<const StoredNormal> normals,
                         std::vector<Cell> cells) {
  const TileIndex index = next_tile();
  if (index >= duplicates_.lists()) fail_changed(kOtherPoints);
  tiling_.tiles.push_back({.first_row = Row{aligned_row(tiling_.row_count())}, .raw = points.size()});
  cells_.emplace_back();
  put(index, points, normals, std::move(cells));
}

void TileStore::finish() {
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
  assert(tiling_.check());
}

TileStore::Filler::Filler(TileStore& store, std::uint64_t memory)
    : tiling_(store.tiling_),
      filled_(tiling_.tiles.size()),
      points_(store.points_, first_rows(tiling_), store.has_normals_ ? memory / 7 * 4 : memory) {
  if (store.has_normals_) normals_.emplace(store.normals_, first_rows(tiling_), memory / 7 * 3);
}

void TileStore::Filler::append(TileIndex tile, std::span<const StoredPoint> points,
                               std::span<const StoredNormal> normals) {
  Filled& filled = filled_[tile];
  // One lock for both: points and normals of a tile stay in the same order.
  const std::lock_guard lock(filled.mutex);
  filled.points += points.size();
  if (filled.points > tiling_.tiles[tile].raw) fail_changed(kOtherPoints);
  points_.append(tile, points);
  if (normals_) normals_->append(tile, normals);
}

void TileStore::Filler::finish() {
  for (std::size_t tile = 0; tile < filled_.size(); ++tile) {
    if (filled_[tile].points != tiling_.tiles[tile].raw) fail_changed(kOtherPoints);
  }
  points_.finish();
  if (normals_) normals_->finish();
}

}  // namespace lacuna
