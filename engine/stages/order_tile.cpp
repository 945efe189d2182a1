#include "engine/stages/order_tile.hpp"

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

// Place along a Z curve through a cell, to 1/256 of its edge. Equal coordinates have equal places.
std::uint32_t z_curve(const StoredPoint& point, double scale) {
  const auto fraction = [&](double x) {
    const double cells = x * scale;
    const double within = (cells - std::floor(cells)) * 256;
    return within < 255 ? static_cast<std::uint32_t>(within) : 255;  // far from the origin: not a number too
  };
  return spread(fraction(point.x)) | spread(fraction(point.y)) << 1 | spread(fraction(point.z)) << 2;
}

}  // namespace

OrderedTile order_tile(std::span<const StoredPoint> points, std::span<const std::uint32_t> cells,
                       std::size_t cell_count, const CellGrid& grid) {
  std::vector<std::uint32_t> begin(cell_count + 1, 0);
  for (const std::uint32_t cell : cells) ++begin[cell + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> by_cell(points.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::uint32_t i = 0; i < points.size(); ++i) by_cell[next[cells[i]]++] = i;

  std::vector<std::uint32_t> places(points.size());
  const double scale = 1 / grid.edge();
  for (std::size_t i = 0; i < points.size(); ++i) places[i] = z_curve(points[i], scale);
  const auto key = [&](std::uint32_t i) {
    return std::tie(places[i], points[i].x, points[i].y, points[i].z, points[i].id);
  };
  const auto same_place = [&](std::uint32_t i, std::uint32_t j) {
    return points[i].x == points[j].x && points[i].y == points[j].y && points[i].z == points[j].z;
  };
  OrderedTile tile;
  tile.order.reserve(points.size());
  tile.cell_points.resize(cell_count);
  for (std::size_t cell = 0; cell < cell_count; ++cell) {
    std::sort(by_cell.begin() + begin[cell], by_cell.begin() + begin[cell + 1],
              [&](std::uint32_t i, std::uint32_t j) { return key(i) < key(j); });
    const std::size_t first = tile.order.size();
    for (std::uint32_t at = begin[cell]; at < begin[cell + 1]; ++at) {
      const std::uint32_t point = by_cell[at];
      if (tile.order.size() > first && same_place(tile.order.back(), point)) {
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
