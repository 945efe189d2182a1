// SPDX-License-Identifier: Apache-2.0
// The points of a tile and its halo, and the proximity graph over them.
#pragma once

#include "engine/model/ids.hpp"

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// Lists of neighbours, flat: list i is indices[offsets[i], offsets[i + 1]).
struct Neighbourhoods {
  std::vector<std::uint32_t> offsets{0};
  std::vector<LocalIndex> indices;

  std::size_t size() const { return offsets.size() - 1; }
  std::span<const LocalIndex> operator[](std::size_t list) const {
    return {indices.data() + offsets[list], indices.data() + offsets[list + 1]};
  }
};

// Distinct points: first the owned points of the tile, in store order, then the foreign points that it needs.
struct TilePoints {
  LocalIndex owned = 0;
  std::vector<Eigen::Vector3d> positions;
  std::vector<PointId> ids;
  std::vector<Row> rows;
  // The foreign points q that have the owned point p among their k nearest. There is one list per owned
  // point.
  Neighbourhoods linked;

  std::size_t size() const { return positions.size(); }
  bool is_owned(LocalIndex point) const { return point < owned; }
};

// The order of neighbours: by squared distance, then by id. Each operation of the distance is rounded alone,
// or exact ties would break. The project is compiled without contraction to fused multiply-add.
inline double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double dx = a.x() - b.x(), dy = a.y() - b.y(), dz = a.z() - b.z();
  return (dx * dx + dy * dy) + dz * dz;
}

struct Neighbour {
  double squared_distance;
  PointId id;
  LocalIndex index;

  friend bool operator<(const Neighbour& a, const Neighbour& b) {
    return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance : a.id < b.id;
  }
};

}  // namespace lacuna
