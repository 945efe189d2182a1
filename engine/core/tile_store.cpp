#include "engine/core/tile_store.hpp"

#include "engine/core/error.hpp"

#include <algorithm>
#include <cassert>

namespace lacuna {

TileStore::TileStore(const std::filesystem::path& folder, Tiling tiling, bool with_normals,
                     std::uint64_t duplicate_budget)
    : tiling_(std::move(tiling)),
      has_normals_(with_normals),
      points_(folder / "points"),
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

void TileStore::put(TileIndex index, std::span<const StoredPoint> points,
                    std::span<const StoredNormal> normals, std::span<const std::uint64_t> cell_points,
                    std::span<const Duplicate> duplicates) {
  Tile& tile = tiling_.tiles[index];
  assert(cell_points.size() == tile.last_cell - tile.first_cell);
  if (points.size() > tile.raw)  // its rows would run into the next tile's
    throw Error("the input changed while it was read: more points in a tile than were counted");
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

}  // namespace lacuna
