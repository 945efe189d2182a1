// SPDX-License-Identifier: Apache-2.0
#include "engine/store/store_writer.hpp"

#include "engine/run/error.hpp"

#include <cstddef>
#include <utility>

namespace lacuna {
namespace {

constexpr const char* kOtherPoints = "not the points that were counted";

}  // namespace

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
