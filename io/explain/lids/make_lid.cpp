// SPDX-License-Identifier: Apache-2.0
#include "io/explain/lids/make_lid.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace lacuna::io {

Eigen::Vector3d area_vector(const LidMesh& mesh, const LidTriangle& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  return (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a) / 2;
}

double area(const LidMesh& mesh) {
  double sum = 0;
  for (const LidTriangle& triangle : mesh.triangles) sum += area_vector(mesh, triangle).norm();
  return sum;
}

namespace {

using Ring = std::vector<std::uint32_t>;

struct Bridge {
  double length = std::numeric_limits<double>::infinity();  // squared
  std::uint32_t from = 0, to = 0;                           // a point of the polygon, a point of the island
};

Eigen::Vector3d area_of_ring(std::span<const Eigen::Vector3d> points, const Ring& ring) {
  Eigen::Vector3d sum(0, 0, 0);
  for (std::size_t i = 0; i < ring.size(); ++i)
    sum += (points[ring[i]] - points[ring[0]]).cross(points[ring[(i + 1) % ring.size()]] - points[ring[0]]);
  return sum;
}

class Bridges {
 public:
  Bridges(std::span<const Eigen::Vector3d> points, std::span<const std::size_t> sizes)
      : points_(points), has_bridge_(points.size(), 0) {
    std::uint32_t first = 0;
    for (const std::size_t size : sizes) {
      Ring& ring = rings_.emplace_back(size);
      std::iota(ring.begin(), ring.end(), first);
      first += static_cast<std::uint32_t>(size);
    }
    const Eigen::Vector3d normal = area_of_ring(points, rings_[0]);
    for (Ring& ring : std::span(rings_).subspan(1)) {
      if (area_of_ring(points, ring).dot(normal) > 0) std::reverse(ring.begin(), ring.end());
    }
  }

  std::optional<Ring> polygon() {
    Ring polygon = rings_[0];
    std::vector<Bridge> bridges(rings_.size());
    for (std::size_t i = 1; i < rings_.size(); ++i) shorten(rings_[0], rings_[i], bridges[i]);
    for (std::vector<char> is_joined(rings_.size(), 0);;) {
      std::size_t next = 0;
      for (std::size_t i = 1; i < rings_.size(); ++i) {
        if (!is_joined[i] && (next == 0 || bridges[i].length < bridges[next].length)) next = i;
      }
      if (next == 0) return polygon;
      const Bridge bridge = bridges[next];
      if (bridge.length == std::numeric_limits<double>::infinity()) return std::nullopt;
      join(rings_[next], bridge, polygon);
      is_joined[next] = 1;
      for (std::size_t i = 1; i < rings_.size(); ++i) {
        if (is_joined[i]) continue;
        const bool is_lost = bridges[i].from == bridge.from;
        if (is_lost) bridges[i] = {};
        shorten(is_lost ? polygon : rings_[next], rings_[i], bridges[i]);
      }
    }
  }

 private:
  void shorten(const Ring& polygon, const Ring& island, Bridge& bridge) const {
    for (const std::uint32_t from : polygon) {
      if (has_bridge_[from]) continue;
      for (const std::uint32_t to : island) {
        const double length = (points_[from] - points_[to]).squaredNorm();
        if (length < bridge.length) bridge = {length, from, to};
      }
    }
  }

  void join(Ring island, const Bridge& bridge, Ring& polygon) {
    std::rotate(island.begin(), std::find(island.begin(), island.end(), bridge.to), island.end());
    island.push_back(bridge.to);
    island.push_back(bridge.from);
    polygon.insert(std::find(polygon.begin(), polygon.end(), bridge.from) + 1, island.begin(), island.end());
    has_bridge_[bridge.from] = has_bridge_[bridge.to] = 1;
  }

  std::span<const Eigen::Vector3d> points_;
  std::vector<Ring> rings_;
  std::vector<char> has_bridge_;
};

// A bridge is the shortest line between a point of the polygon and a point of an island. The polygon passes
// it in both directions, with the island between them, so it has the bridge's ends twice. Islands with
// shorter bridges come first. Each island runs against the loop, in whichever direction it is given.
//
// `points`: of the loop, then of the islands; `sizes`: their numbers of points. No point has two bridges.
// Returns indices of points, or nothing if there are too few points for the bridges. Ties: by order. Cost:
// the product of all points and the islands' points.
std::optional<Ring> bridge_rings(std::span<const Eigen::Vector3d> points,
                                 std::span<const std::size_t> sizes) {
  return Bridges(points, sizes).polygon();
}

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

namespace {

Lid without_lid(std::string reason) {
  return {.mesh = {}, .area = 0, .left_out = std::move(reason)};
}

// Whether each edge is on at most two triangles, once in each direction.
bool is_surface(const LidMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const LidTriangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(triangle[i], triangle[(i + 1) % 3]);
  }
  std::ranges::sort(edges);
  return std::ranges::adjacent_find(edges) == edges.end();
}

double square_of_extent(std::span<const Eigen::Vector3d> points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  return box.diagonal().squaredNorm();
}

}  // namespace

std::string left_out(std::uint64_t points, std::size_t islands) {
  if (points < 3) return "fewer than 3 points";
  if (points > kMostLoopPoints) return "more than " + std::to_string(kMostLoopPoints) + " points";
  if (islands > kMostIslands) return "more than " + std::to_string(kMostIslands) + " islands in it";
  return {};
}

Lid make_lid(const Loop& loop, std::span<const Loop> islands) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::size_t> sizes;
  const auto add = [&](const Loop& ring) {
    for (const LoopPoint& point : ring) points.push_back(point.position());
    sizes.push_back(ring.size());
  };
  add(loop);
  for (const Loop& island : islands) add(island);
  if (std::string reason = left_out(points.size(), islands.size()); !reason.empty())
    return without_lid(std::move(reason));
  LidMesh mesh = triangulate_rings(points, sizes);
  if (mesh.triangles.empty() || !is_surface(mesh)) return without_lid("no surface leaves its islands open");
  constexpr double kNoArea = 1e-12;  // of the square of the extent: rounding
  const double size = area(mesh);
  if (!(size > kNoArea * square_of_extent(points))) return without_lid("all points in one line");
  return {.mesh = std::move(mesh), .area = size, .left_out = {}};
}

}  // namespace lacuna::io
