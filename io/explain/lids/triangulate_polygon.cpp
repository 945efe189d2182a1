// SPDX-License-Identifier: Apache-2.0
#include "io/explain/lids/triangulate_polygon.hpp"

#include "io/explain/lids/bridge_rings.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna::io {
namespace {

using Polygon = std::vector<std::uint32_t>;  // indices of points, in the order of the loop
using Points = std::span<const Eigen::Vector3d>;

double area_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b - a).cross(c - a).norm() / 2;
}

// The apex of the best triangle on each diagonal, as indices into the polygon.
class LeastArea {
 public:
  LeastArea(Points points, const Polygon& polygon)
      : size_(polygon.size()), least_(size_ * size_, 0.0), apex_(size_ * size_, 0) {
    for (std::size_t width = 2; width < size_; ++width) {
      for (std::size_t first = 0; first + width < size_; ++first) {
        const std::size_t last = first + width;
        double least = std::numeric_limits<double>::infinity();
        std::size_t best = first + 1;
        for (std::size_t k = first + 1; k < last; ++k) {
          if (has_twice(polygon[first], polygon[k], polygon[last])) continue;
          const double sum = least_[at(first, k)] + least_[at(k, last)] +
                             area_of(points[polygon[first]], points[polygon[k]], points[polygon[last]]);
          if (sum < least) {
            least = sum;
            best = k;
          }
        }
        least_[at(first, last)] = least;
        apex_[at(first, last)] = static_cast<std::uint16_t>(best);
      }
    }
  }

  // Whether any triangulation has no triangle with one point twice.
  bool exists() const { return least_[at(0, size_ - 1)] < std::numeric_limits<double>::infinity(); }

  // visit(first, apex, last) for each triangle.
  template <class Visit>
  void for_each_triangle(Visit&& visit) const {
    std::vector<std::pair<std::size_t, std::size_t>> diagonals = {{0, size_ - 1}};
    while (!diagonals.empty()) {
      const auto [first, last] = diagonals.back();
      diagonals.pop_back();
      if (last - first < 2) continue;
      const std::size_t apex = apex_[at(first, last)];
      visit(first, apex, last);
      diagonals.emplace_back(apex, last);
      diagonals.emplace_back(first, apex);
    }
  }

 private:
  static bool has_twice(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return a == b || b == c || c == a;
  }
  std::size_t at(std::size_t first, std::size_t last) const { return first * size_ + last; }

  std::size_t size_;
  std::vector<double> least_;
  std::vector<std::uint16_t> apex_;
};

// Returns the polygon with `most` of its vertices, the ones that turn most, as indices into it. Points that
// are fixed are among them.
// Visvalingam, Whyatt, *Line generalisation by repeated elimination of points*, Cartographic Journal 1993.
std::vector<std::size_t> simplify(Points points, const Polygon& polygon, const std::vector<char>& is_fixed,
                                  std::size_t most) {
  const std::size_t n = polygon.size();
  std::vector<std::size_t> before(n), after(n);
  for (std::size_t i = 0; i < n; ++i) {
    before[i] = (i + n - 1) % n;
    after[i] = (i + 1) % n;
  }
  const auto triangle = [&](std::size_t i) {
    return area_of(points[polygon[before[i]]], points[polygon[i]], points[polygon[after[i]]]);
  };
  using Entry = std::tuple<double, std::size_t, std::uint32_t>;  // area, vertex, version
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> smallest;
  std::vector<std::uint32_t> version(n, 0);
  std::vector<char> is_left(n, 1);
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_fixed[polygon[i]]) smallest.emplace(triangle(i), i, 0);
  }
  for (std::size_t left = n; left > most && !smallest.empty();) {
    const auto [area, i, entered] = smallest.top();
    smallest.pop();
    if (!is_left[i] || entered != version[i]) continue;
    is_left[i] = 0;
    --left;
    after[before[i]] = after[i];
    before[after[i]] = before[i];
    for (const std::size_t neighbour : {before[i], after[i]}) {
      if (is_fixed[polygon[neighbour]]) continue;
      smallest.emplace(triangle(neighbour), neighbour, ++version[neighbour]);
    }
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < n; ++i) {
    if (is_left[i]) kept.push_back(i);
  }
  return kept;
}

// Appends the vertices of the polygon from one to another, the last one left out.
void append_part(Polygon& part, const Polygon& polygon, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i != to; i = (i + 1) % polygon.size()) part.push_back(polygon[i]);
}

// Returns the triangles of a polygon of these points; none if there is no triangulation.
std::vector<LidTriangle> triangulate(Points points, Polygon of, const std::vector<char>& is_fixed,
                                     std::size_t most_at_once) {
  std::vector<LidTriangle> triangles;
  std::vector<Polygon> polygons{std::move(of)};
  while (!polygons.empty()) {
    const Polygon polygon = std::move(polygons.back());
    polygons.pop_back();
    if (polygon.size() <= most_at_once) {
      const LeastArea least(points, polygon);
      if (!least.exists()) return {};
      least.for_each_triangle([&](std::size_t first, std::size_t apex, std::size_t last) {
        triangles.push_back({polygon[first], polygon[apex], polygon[last]});
      });
      continue;
    }
    const std::vector<std::size_t> kept = simplify(points, polygon, is_fixed, most_at_once);
    Polygon coarse;
    for (const std::size_t i : kept) coarse.push_back(polygon[i]);
    // Corners that follow each other are the ends of a part of the loop; others of a diagonal.
    const auto append = [&](Polygon& part, std::size_t from, std::size_t to) {
      if ((from + 1) % kept.size() == to) return append_part(part, polygon, kept[from], kept[to]);
      part.push_back(coarse[from]);
    };
    const LeastArea least(points, coarse);
    if (!least.exists()) return {};
    least.for_each_triangle([&](std::size_t first, std::size_t apex, std::size_t last) {
      Polygon part;
      append(part, first, apex);
      append(part, apex, last);
      append(part, last, first);
      polygons.push_back(std::move(part));
    });
  }
  return triangles;
}

LidMesh mesh_of(Points points, std::vector<LidTriangle> triangles) {
  return {.vertices = {points.begin(), points.end()}, .triangles = std::move(triangles)};
}

}  // namespace

LidMesh triangulate_polygon(Points loop) {
  assert(loop.size() >= 3);
  Polygon polygon(loop.size());
  std::iota(polygon.begin(), polygon.end(), 0U);
  return mesh_of(loop, triangulate(loop, std::move(polygon), std::vector<char>(loop.size(), 0), kMostAtOnce));
}

LidMesh triangulate_rings(Points points, std::span<const std::size_t> sizes) {
  assert(sizes.size() <= kMostIslands + 1);
  if (sizes.size() == 1) return triangulate_polygon(points);
  std::optional<Polygon> polygon = bridge_rings(points, sizes);
  if (!polygon) return mesh_of(points, {});
  std::vector<char> is_fixed(points.size(), 0), is_met(points.size(), 0);
  for (const std::uint32_t i : *polygon) (is_met[i] ? is_fixed : is_met)[i] = 1;
  std::size_t first = sizes[0];
  for (const std::size_t size : sizes.subspan(1)) {
    constexpr std::size_t kFixed = 8;
    const std::size_t fixed = std::min(kFixed, size);
    for (std::size_t i = 0; i < fixed; ++i) is_fixed[first + i * size / fixed] = 1;
    first += size;
  }
  constexpr std::size_t kMostWithIslands = 2 * kMostAtOnce;  // 12 for each island may be fixed
  static_assert(12 * kMostIslands < kMostWithIslands);
  return mesh_of(points, triangulate(points, *std::move(polygon), is_fixed, kMostWithIslands));
}

}  // namespace lacuna::io
