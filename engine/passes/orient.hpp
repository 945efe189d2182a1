// Consistent orientation of the normals over all tiles (Hoppe et al. 1992), exact.
#pragma once

#include "engine/passes/evaluate.hpp"

namespace lacuna {

// Rows whose normal has to be turned round. The minimum spanning tree of G is built from each tile's own
// spanning forest and the edges between tiles, sorted on disk, by a union-find that carries the sign. In
// every component the topmost point (largest z, then lowest id) gets a normal that points up: its first
// coordinate of z, y, x that is not 0 is positive. Memory: the global budget. Consumes the orientation
// lists of `scan`.
RowSet orient_normals(EvaluatedScan& scan, const TileStore& store, Job& job);

}  // namespace lacuna
