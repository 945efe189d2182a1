// SPDX-License-Identifier: Apache-2.0
#include "engine/model/tiling.hpp"

#include <algorithm>

namespace lacuna {

void Tiling::build_tree() {
  nodes.clear();
  if (!cells.empty()) build_node(0, static_cast<std::uint32_t>(cells.size()));
}

std::uint32_t Tiling::build_node(std::uint32_t first, std::uint32_t last) {
  const auto index = static_cast<std::uint32_t>(nodes.size());
  nodes.push_back({.first = first, .last = last});
  CellNode node{.first = first, .last = last};
  if (last - first <= kLeafCells) {
    for (std::uint32_t cell = first; cell < last; ++cell) {
      node.box.extend(cells[cell].box);
      node.points += cells[cell].points;
    }
  } else {
    const std::uint32_t middle = halve(first, last);
    node.left = build_node(first, middle);
    node.right = build_node(middle, last);
    node.box = nodes[node.left].box.merged(nodes[node.right].box);
    node.points = nodes[node.left].points + nodes[node.right].points;
  }
  nodes[index] = node;
  return index;
}

// Returns the first cell of the second half.
std::uint32_t Tiling::halve(std::uint32_t first, std::uint32_t last) const {
  const std::uint64_t end = value(cells[last - 1].first_row) + cells[last - 1].points;
  const Row half{(value(cells[first].first_row) + end) / 2};
  const auto after = std::upper_bound(cells.begin() + first, cells.begin() + last, half,
                                      [](Row row, const Cell& cell) { return row < cell.first_row; });
  const auto middle = std::clamp(static_cast<std::uint32_t>(after - cells.begin()) - 1, first + 1, last - 1);
  const TileIndex tile = tile_of_cell(middle);
  if (tiles[tile].first_cell > first) return tiles[tile].first_cell;
  if (tiles[tile].last_cell < last) return tiles[tile].last_cell;
  return middle;
}

TileIndex Tiling::tile_of_cell(std::uint32_t cell) const {
  const auto after = std::upper_bound(tiles.begin(), tiles.end(), cell,
                                      [](std::uint32_t c, const Tile& tile) { return c < tile.first_cell; });
  return static_cast<TileIndex>(after - tiles.begin() - 1);
}

TileIndex Tiling::tile_of_row(Row row) const {
  const auto after = std::upper_bound(tiles.begin(), tiles.end(), row,
                                      [](Row r, const Tile& tile) { return r < tile.first_row; });
  return static_cast<TileIndex>(after - tiles.begin() - 1);
}

std::vector<TileIndex> Tiling::tiles_of(std::span<const Row> rows) const {
  std::vector<TileIndex> found;
  for (const Row row : rows) {
    // The tile found last is tried first: rows mostly come in runs.
    const bool is_new =
        std::none_of(found.rbegin(), found.rend(), [&](TileIndex t) { return tiles[t].owns(row); });
    if (is_new) found.push_back(tile_of_row(row));
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::uint64_t Tiling::row_count() const {
  return tiles.empty() ? 0 : value(tiles.back().first_row) + tiles.back().raw;
}

std::uint64_t Tiling::points() const {
  std::uint64_t points = 0;
  for (const Tile& tile : tiles) points += tile.points;
  return points;
}

TileRange Tiling::tiles_in(const TaskShare& share) const {
  std::vector<std::uint64_t> weights;
  weights.reserve(tiles.size());
  for (const Tile& tile : tiles) weights.push_back(tile.points);
  const IndexRange range = share_of(weights, share);
  return {static_cast<TileIndex>(range.first), static_cast<TileIndex>(range.last)};
}

bool Tiling::check() const {
  std::uint32_t cell = 0;
  std::uint64_t row = 0;  // the first that is free
  for (const Tile& tile : tiles) {
    if (tile.first_cell != cell || tile.last_cell < cell || tile.last_cell > cells.size()) return false;
    if (value(tile.first_row) < row || value(tile.first_row) % kRowAlignment != 0) return false;
    if (tile.points > tile.raw) return false;
    std::uint64_t next = value(tile.first_row);
    for (; cell < tile.last_cell; next += cells[cell++].points) {
      if (value(cells[cell].first_row) != next || cells[cell].points == 0) return false;
    }
    if (next != value(tile.first_row) + tile.points) return false;
    row = value(tile.first_row) + tile.raw;
  }
  if (cell != cells.size()) return false;
  if (nodes.empty()) return cells.empty();
  if (nodes[0].first != 0 || nodes[0].last != cells.size()) return false;
  return std::all_of(nodes.begin(), nodes.end(), [&](const CellNode& node) {
    if (node.left == 0) return node.first < node.last;
    const CellNode &left = nodes[node.left], &right = nodes[node.right];
    return left.first == node.first && left.last == right.first && right.last == node.last &&
           node.points == left.points + right.points;
  });
}

// The bounds are rounded in the same order as the distances of points. Rounding is monotone, so it keeps the
// bounds.
namespace {

double squared_length(const Eigen::Array3d& offset) {
  return (offset.x() * offset.x() + offset.y() * offset.y()) + offset.z() * offset.z();
}

}  // namespace

double min_squared_distance(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  const Eigen::Array3d before = (a.min() - b.max()).array();
  const Eigen::Array3d after = (b.min() - a.max()).array();
  return squared_length(before.max(after).max(0.0));
}

double max_squared_distance(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  const Eigen::Array3d down = (a.max() - b.min()).array();
  const Eigen::Array3d up = (b.max() - a.min()).array();
  return squared_length(down.max(up));
}

}  // namespace lacuna
