// SPDX-License-Identifier: Apache-2.0
#include "engine/bucket/order_tile.hpp"

#include "engine/bucket/z_curve.hpp"
#include "engine/simd/vectorised.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace lacuna {

namespace {

// Spreads the lowest 8 bits to every third bit of the result.
std::uint32_t spread(std::uint32_t bits) {  // ................hgfedcba
  bits = (bits | bits << 8) & 0x0f00f;      // ........hgfe........dcba
  bits = (bits | bits << 4) & 0xc30c3;      // ....hg....fe....dc....ba
  return (bits | bits << 2) & 0x249249;     // ..h..g..f..e..d..c..b..a
}

// Returns where a coordinate lies within its cell, to 1/256 of the edge: 255 where rounding leaves no
// fraction.
std::uint32_t fraction(double x, double scale, double origin) {
  const double cells = x * scale - origin;
  const double within = (cells - std::floor(cells)) * 256;
  return within < 255 ? static_cast<std::uint32_t>(static_cast<std::int32_t>(within)) : 255;
}

// Makes the key of each point: its place along a Z curve through its cell, in the high half, and its index.
// Equal coordinates have equal places.
LACUNA_VECTORISED
void make_keys(const ScanPoint* points, std::size_t count, double scale, double origin_x, double origin_y,
               double origin_z, std::uint64_t* keys) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t place = spread(fraction(points[i].x, scale, origin_x)) |
                                spread(fraction(points[i].y, scale, origin_y)) << 1 |
                                spread(fraction(points[i].z, scale, origin_z)) << 2;
    keys[i] = std::uint64_t{place} << 32 | i;
  }
}

std::uint64_t place_of(std::uint64_t key) {
  return key >> 32;
}

std::uint32_t index_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}

// Sorts by place, then by coordinates and id. Few points share a place: only those are sorted again.
void sort_cell(std::span<std::uint64_t> keys, std::span<const ScanPoint> points) {
  const auto by_point = [&](std::uint64_t a, std::uint64_t b) {
    const ScanPoint &p = points[index_of(a)], &q = points[index_of(b)];
    return std::tie(p.x, p.y, p.z, p.id) < std::tie(q.x, q.y, q.z, q.id);
  };
  std::sort(keys.begin(), keys.end());
  for (auto begin = keys.begin(), end = begin; begin != keys.end(); begin = end) {
    while (end != keys.end() && place_of(*end) == place_of(*begin)) ++end;
    if (end - begin > 1) std::sort(begin, end, by_point);
  }
}

bool coincide(const ScanPoint& p, const ScanPoint& q) {
  return p.x == q.x && p.y == q.y && p.z == q.z;
}

class Orderer {
 public:
  Orderer(std::span<const ScanPoint> points, std::uint64_t cell_points)
      : points_(points), cell_points_(cell_points) {
    tile_.order.reserve(points.size());
  }

  OrderedTile take() { return std::move(tile_); }

  // Adds points of one counted cell, with their places on its coarse curve.
  void add_cell(std::span<std::uint64_t> keys) {
    if (keys.size() > 4 * cell_points_) {
      add_crowded_cell(keys);
      return;
    }
    sort_cell(keys, points_);
    const std::size_t first = tile_.order.size();
    for (const std::uint64_t key : keys) keep(index_of(key), first);
    close_cell(first);
  }

 private:
  struct Placed {
    ZPlace place;
    std::uint32_t point;
  };

  // The whole precision of the coordinates orders these.
  void add_crowded_cell(std::span<const std::uint64_t> keys) {
    Eigen::AlignedBox3d box;
    for (const std::uint64_t key : keys) box.extend(points_[index_of(key)].position());
    const ZCurve curve(box);
    std::vector<Placed> placed;
    placed.reserve(keys.size());
    for (const std::uint64_t key : keys)
      placed.push_back({curve.place(points_[index_of(key)].position()), index_of(key)});
    std::sort(placed.begin(), placed.end(), [&](const Placed& a, const Placed& b) {
      if (a.place != b.place) return comes_before(a.place, b.place);
      const ScanPoint &p = points_[a.point], &q = points_[b.point];
      return std::tie(p.x, p.y, p.z, p.id) < std::tie(q.x, q.y, q.z, q.id);
    });
    const std::size_t first = tile_.order.size();
    std::vector<ZPlace> places;
    for (const Placed& p : placed) {
      if (keep(p.point, first)) places.push_back(p.place);
    }
    std::size_t begin = first;
    const std::vector<std::uint32_t> ends = cut_runs(places, cell_points_);
    for (const std::uint32_t end : ends) {
      close_cell(begin, first + end);
      begin = first + end;
    }
  }

  // Copies come one after the other. `first`: the first point of the counted cell.
  bool keep(std::uint32_t point, std::size_t first) {
    if (tile_.order.size() > first && coincide(points_[tile_.order.back()], points_[point])) {
      tile_.duplicates.push_back({points_[point].id, static_cast<LocalIndex>(tile_.order.size() - 1)});
      return false;
    }
    tile_.order.push_back(point);
    return true;
  }

  void close_cell(std::size_t first) { close_cell(first, tile_.order.size()); }
  void close_cell(std::size_t first, std::size_t last) {
    if (first == last) return;
    Cell cell{.points = last - first};
    for (std::size_t i = first; i < last; ++i) cell.box.extend(points_[tile_.order[i]].position());
    tile_.cells.push_back(cell);
  }

  std::span<const ScanPoint> points_;
  std::uint64_t cell_points_;
  OrderedTile tile_;
};

}  // namespace

OrderedTile order_tile(std::span<const ScanPoint> points, std::span<const std::uint32_t> cells,
                       std::size_t cell_count, const CellGrid& grid, std::uint64_t cell_points) {
  std::vector<std::uint32_t> begin(cell_count + 1, 0);
  for (const std::uint32_t cell : cells) ++begin[cell + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint64_t> keys(points.size()), by_cell(points.size());
  const double coarser = std::ldexp(1.0, -grid.shift);
  make_keys(points.data(), points.size(), 1 / grid.edge(), grid.origin[0] * coarser, grid.origin[1] * coarser,
            grid.origin[2] * coarser, keys.data());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) by_cell[next[cells[i]]++] = keys[i];

  Orderer orderer(points, cell_points);
  for (std::size_t cell = 0; cell < cell_count; ++cell)
    orderer.add_cell(std::span(by_cell).subspan(begin[cell], begin[cell + 1] - begin[cell]));
  return orderer.take();
}

}  // namespace lacuna
