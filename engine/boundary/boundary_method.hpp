// SPDX-License-Identifier: Apache-2.0
// The steps that both methods have in common. A method takes boundary edges from the evaluated tiles,
// stitches them across tiles, and finds loops in the components.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/evaluate/totals.hpp"
#include "engine/loops/loops.hpp"
#include "engine/store/rows.hpp"

#include <cstdint>

namespace lacuna {

struct FoundLoops {
  Loops loops;                    // sorted
  std::uint64_t edges = 0;        // of the boundary graph
  std::uint64_t components = 0;   // of the boundary graph, with an edge
  std::int64_t minimum_loop = 0;  // e, in effect; 0: the method has no e
};

// The steps of a level, each called once, in this order.
class BoundaryMethod {
 public:
  virtual ~BoundaryMethod() = default;

  // Emits the boundary edges of a tile, as far as the tile alone can find them. From any thread.
  virtual void emit(const EvaluatedTile& tile, TileOutput& output) const = 0;
  // Completes the boundary edges with the data that tiles need of each other.
  virtual void complete_edges(const TileOutputs& outputs) = 0;
  // Finds the loops that lie inside one tile, and joins the components of the boundary graph across tiles.
  virtual void stitch(const TileOutputs& outputs, const Totals& totals) = 0;
  // Finds the loops of the components that cross tiles. Returns all loops.
  virtual FoundLoops find_loops(const TileOutputs& outputs) = 0;

  // Returns the candidates that belong to the boundary, in addition to the points on loops. `on_loop`: these
  // points.
  virtual RowSet boundary_candidates(const TileOutputs& outputs, const RowSet& coherent,
                                     const RowSet& on_loop) const = 0;
};

// Returns an owned point in the form that loops have.
inline LoopPoint loop_point_of(const EvaluatedTile& tile, LocalIndex owned) {
  const Eigen::Vector3f surface = tile.evaluations[owned].mean_offset.cast<float>();
  return {tile.point(owned), {surface.x(), surface.y(), surface.z()}, tile.probability(owned)};
}

}  // namespace lacuna
