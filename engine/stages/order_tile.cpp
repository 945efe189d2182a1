#include "engine/stages/order_tile.hpp"

#include "engine/simd/vectorised.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace lacuna {

namespace {

// Every third bit of the result, from the lowest 8 bits.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 8) & 0x0f00f;
  bits = (bits | bits << 4) & 0xc30c3;
  return (bits | bits << 2) & 0x249249;
}

// Of a coordinate within its cell, to 1/256 of the edge; 255 far from the origin, where that is not a number.
std::uint32_t fraction(double x, double scale) {
  const double cells = x * scale;
  const double within = (cells - std::floor(cells)) * 256;
  return within < 255 ? static_cast<std::uint32_t>(static_cast<std::int32_t>(within)) : 255;
}

// Of each point: its place along a Z curve through its cell, in the high half, and its index. Equal
// coordinates have equal places.
LACUNA_VECTORISED
void make_keys(const StoredPoint* points, std::size_t count, double scale, std::uint64_t* keys) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t place = spread(fraction(points[i].x, scale)) |
                                spread(fraction(points[i].y, scale)) << 1 |
                                spread(fraction(points[i].z, scale)) << 2;
    keys[i] = std::uint64_t{place} << 32 | i;
  }
}

std::uint64_t place_of(std::uint64_t key) {
  return key >> 32;
}

std::uint32_t index_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}

// By place, then by coordinates and id. Few points share a place: only those are looked at.
void sort_cell(std::span<std::uint64_t> keys, std::span<const StoredPoint> points) {
  const auto by_point = [&](std::uint64_t a, std::uint64_t b) {
    const StoredPoint &p = points[index_of(a)], &q = points[index_of(b)];
    return std::tie(p.x, p.y, p.z, p.id) < std::tie(q.x, q.y, q.z, q.id);
  };
  std::sort(keys.begin(), keys.end());
  for (auto begin = keys.begin(), end = begin; begin != keys.end(); begin = end) {
    while (end != keys.end() && place_of(*end) == place_of(*begin)) ++end;
    if (end - begin > 1) std::sort(begin, end, by_point);
  }
}

bool coincide(const StoredPoint& p, const StoredPoint& q) {
  return p.x == q.x && p.y == q.y && p.z == q.z;
}

}  // namespace

OrderedTile order_tile(std::span<const StoredPoint> points, std::span<const std::uint32_t> cells,
                       std::size_t cell_count, const CellGrid& grid) {
  std::vector<std::uint32_t> begin(cell_count + 1, 0);
  for (const std::uint32_t cell : cells) ++begin[cell + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint64_t> keys(points.size()), by_cell(points.size());
  make_keys(points.data(), points.size(), 1 / grid.edge(), keys.data());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) by_cell[next[cells[i]]++] = keys[i];

  OrderedTile tile;
  tile.order.reserve(points.size());
  tile.cell_points.resize(cell_count);
  for (std::size_t cell = 0; cell < cell_count; ++cell) {
    const auto in_cell = std::span(by_cell).subspan(begin[cell], begin[cell + 1] - begin[cell]);
    sort_cell(in_cell, points);
    const std::size_t first = tile.order.size();
    for (std::size_t i = 0; i < in_cell.size(); ++i) {
      const std::uint32_t point = index_of(in_cell[i]);
      if (i > 0 && place_of(in_cell[i]) == place_of(in_cell[i - 1]) &&
          coincide(points[tile.order.back()], points[point])) {
        tile.duplicates.push_back({points[point].id, static_cast<LocalIndex>(tile.order.size() - 1)});
      } else {
        tile.order.push_back(point);
      }
    }
    tile.cell_points[cell] = tile.order.size() - first;
  }
  return tile;
}

}  // namespace lacuna
