#include "engine/store/tile_store.hpp"

#include "engine/core/error.hpp"

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

TileStore::TileStore(const std::filesystem::path& folder, Tiling tiling, Precision precision,
                     bool with_normals, std::uint64_t duplicate_budget)
    : tiling_(std::move(tiling)),
      has_normals_(with_normals),
      points_(folder / "points", precision),
      normals_(folder / "normals"),
      duplicates_(folder / "duplicates", tiling_.tiles.size(), duplicate_budget) {
  tiling_.cell_rows.resize(tiling_.cells.size());
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

std::vector<Duplicate> TileStore::duplicates(TileIndex tile) const {
  std::vector<Duplicate> duplicates = duplicates_.read(tile);
  std::sort(duplicates.begin(), duplicates.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return duplicates;
}

std::vector<StoredPoint> TileStore::cell(std::uint32_t cell) const {
  return points_.read(value(tiling_.cell_rows[cell]), tiling_.cells[cell].points);
}

void TileStore::read_cells(std::span<const std::uint32_t> cells, std::vector<StoredPoint>& points,
                           std::vector<Row>& rows) const {
  points.clear();
  rows.clear();
  for (std::size_t i = 0; i < cells.size();) {
    // Cells whose points follow each other in the store are one read.
    const std::uint64_t first = value(tiling_.cell_rows[cells[i]]);
    std::uint64_t end = first;
    for (; i < cells.size() && value(tiling_.cell_rows[cells[i]]) == end; ++i)
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
                    std::span<const StoredNormal> normals, std::span<const std::uint64_t> cell_points,
                    std::span<const Duplicate> duplicates) {
  Tile& tile = tiling_.tiles[index];
  assert(cell_points.size() == tile.last_cell - tile.first_cell);
  if (points.size() > tile.raw)  // its rows would run into the next tile's
    fail_changed(kOtherPoints);
  tile.points = points.size();
  std::uint64_t row = value(tile.first_row);
  for (std::uint32_t cell = tile.first_cell; cell < tile.last_cell; ++cell) {
    tiling_.cells[cell].points = cell_points[cell - tile.first_cell];
    tiling_.cell_rows[cell] = Row{row};
    row += tiling_.cells[cell].points;
  }
  points_.write(value(tile.first_row), points);
  if (has_normals_) normals_.write(value(tile.first_row), normals);
  duplicates_.append(index, duplicates);
}

void TileStore::seal() {
  tiling_.recount();
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
