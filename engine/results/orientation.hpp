// SPDX-License-Identifier: Apache-2.0
// orient: orients the normals over all tiles consistently, by a minimum spanning tree of G. The result is
// exact. Source: Hoppe et al. 1992.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/model/ids.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/phase.hpp"
#include "engine/store/rows.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lacuna {

// An edge of G for the orientation of normals.
struct OrientationEdge {
  double weight;  // 1 - |n_a . n_b|
  PointId low_id, high_id;
  Row low, high;
  std::uint64_t opposed;  // the normals point to different sides

  friend bool operator<(const OrientationEdge& x, const OrientationEdge& y) {
    if (x.weight != y.weight) return x.weight < y.weight;
    return x.low_id != y.low_id ? x.low_id < y.low_id : x.high_id < y.high_id;
  }
};

struct OrientedEnd {
  PointId id;
  Row row;
  Eigen::Vector3d normal;
};

// Returns the edge of G between two points: weight 1 - |n_a . n_b|, ties by ids.
OrientationEdge orientation_edge(const OrientedEnd& a, const OrientedEnd& b);

// Returns the edges of the minimum spanning forest of a graph over rows [first_row, first_row + rows).
std::vector<OrientationEdge> spanning_forest(std::vector<OrientationEdge> edges, std::uint64_t first_row,
                                             LocalIndex rows);

// An edge of G between tiles, in the list of the tile that has its lower id.
struct OrientationCrossing {
  LocalIndex owned;
  Row foreign;
  PointId foreign_id;
};

// An edge that is the heaviest on a cycle inside one tile is in no minimum spanning tree. So a tile emits
// only its own spanning forest of its inner edges, with the normals and the edges between tiles.
void emit_orientation(const EvaluatedTile& tile, TileOutput& output);

// Returns the rows whose normal has to be turned round. The minimum spanning tree of G is built from the
// tiles' forests and the edges between tiles. They are sorted on disk, and a union-find carries the sign. In
// every component, the normal of the topmost point (largest z, then lowest id) points up. The first
// coordinate of z, y, x of that normal that is not 0 is positive. Memory: the global budget.
RowSet opposed_normals(const TileOutputs& outputs, const TileStore& store, const Spill& spill,
                       const Workers& workers, Phases& phases);

}  // namespace lacuna
