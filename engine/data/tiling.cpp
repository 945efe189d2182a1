#include "engine/data/tiling.hpp"

#include "engine/simd/vectorised.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lacuna {

namespace {

// Exact to multiply by, so every pass finds the same cell. Exponents of grids are those of normal numbers.
double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}

LACUNA_VECTORISED
void round_down(const double* coordinates, std::size_t count, double scale, int shift, std::int32_t* cells) {
  constexpr double kLast = CellGrid::kLast;
  for (std::size_t i = 0; i < count; ++i) {
    const double index = std::max(-kLast, std::min(kLast, coordinates[i] * scale));  // NaN: kLast
    const auto truncated = static_cast<std::int32_t>(index);
    cells[i] = (truncated - (truncated > index)) >> shift;
  }
}

}  // namespace

double CellGrid::edge() const {
  return power_of_two(finest + shift);
}

CellCoord CellGrid::cell_of(const Eigen::Vector3d& position) const {
  CellCoord cell;
  cells_of({&position, 1}, {&cell, 1});
  return cell;
}

void CellGrid::cells_of(std::span<const Eigen::Vector3d> positions, std::span<CellCoord> cells) const {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && sizeof(CellCoord) == 12);
  assert(positions.size() == cells.size());
  if (positions.empty()) return;
  round_down(positions.front().data(), 3 * positions.size(), power_of_two(-finest), shift,
             cells.front().data());
}

Eigen::AlignedBox3d CellGrid::box(const CellCoord& low, const CellCoord& high) const {
  constexpr double kEverywhere = std::numeric_limits<double>::infinity();
  const std::int32_t last = kLast >> shift;
  Eigen::AlignedBox3d box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = low[axis] == -last ? -kEverywhere : low[axis] * edge();
    box.max()[axis] = high[axis] == last ? kEverywhere : (high[axis] + 1.0) * edge();
  }
  return box;
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
    // The one found last is asked first: rows mostly come in runs.
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

void Tiling::recount() {
  for (std::size_t i = nodes.size(); i-- > 0;) {  // children come after their parent
    CellNode& node = nodes[i];
    node.points = 0;
    if (node.left != 0) {
      node.points = nodes[node.left].points + nodes[node.right].points;
    } else {
      for (std::uint32_t cell = node.first; cell < node.last; ++cell) node.points += cells[cell].points;
    }
  }
}

bool Tiling::check() const {
  if (!cell_rows.empty() && cell_rows.size() != cells.size()) return false;
  std::uint32_t cell = 0;
  std::uint64_t row = 0;  // the first that is free
  for (const Tile& tile : tiles) {
    if (tile.first_cell != cell || tile.last_cell <= cell || tile.last_cell > cells.size()) return false;
    if (value(tile.first_row) < row || value(tile.first_row) % kRowAlignment != 0) return false;
    if (tile.points > tile.raw) return false;
    if (!cell_rows.empty()) {
      std::uint64_t next = value(tile.first_row);
      for (std::uint32_t c = cell; c < tile.last_cell; next += cells[c++].points) {
        if (value(cell_rows[c]) != next) return false;
      }
      if (next != value(tile.first_row) + tile.points) return false;
    }
    cell = tile.last_cell;
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

// Rounded in the same order as the distances of points, so that rounding, being monotone, keeps the bounds.
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
