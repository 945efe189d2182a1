// SPDX-License-Identifier: Apache-2.0
#include "io/explain/lids/bridge_rings.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

namespace lacuna::io {
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

}  // namespace

std::optional<std::vector<std::uint32_t>> bridge_rings(std::span<const Eigen::Vector3d> points,
                                                       std::span<const std::size_t> sizes) {
  return Bridges(points, sizes).polygon();
}

}  // namespace lacuna::io
