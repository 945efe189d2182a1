// SPDX-License-Identifier: Apache-2.0
// Candidates: points whose Pi exceeds the threshold (paper, 5.1). This finds which of them belong to the
// boundary.
#pragma once

#include "engine/boundary/coherence.hpp"
#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/phase.hpp"
#include "engine/store/row_set.hpp"

#include <cstdint>

namespace lacuna {

struct CandidatePoint : ScanPoint {
  float probability;
  std::uint32_t padding = 0;  // all bytes are in the checksum of a part
};

// A tile's candidates that have gap neighbours, in ascending row, and their points.
inline constexpr RecordStream<Candidate> kCandidates{"candidates"};
inline constexpr RecordStream<CandidatePoint> kCandidatePoints{"candidate points"};
void emit_candidates(const EvaluatedTile& tile, TileOutput& output);

// Returns the coherent candidates: the greatest set of candidates in which each has both of its gap
// neighbours. Tiles are evaluated on their own, and again while a tile that their candidates depend on
// changes. The order does not matter. Memory: one bit per row.
RowSet coherent_candidates(const TileOutputs& outputs, const Tiling& tiling, const TaskArena& arena,
                           Phases& phases);

// Returns the candidates whose gap neighbours both lie on loops.
RowSet candidates_between(const RowSet& on_loop, const TileOutputs& outputs, const Tiling& tiling,
                          const TaskArena& arena);

}  // namespace lacuna
