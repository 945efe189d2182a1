// SPDX-License-Identifier: Apache-2.0
// candidates: points whose Pi exceeds the threshold, and which of them belong to the boundary (paper, 5.1;
// method.md, B.1).
//
// Idea: a boundary point lies between two other boundary points. So a candidate stays boundary only while
// both of its gap neighbours are. That is a greatest fixed point, which tiles reach in any order.
//
// Source: the paper, 5.1. Cost: linear in the candidates.
#pragma once

#include "engine/evaluate/evaluated_tile.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/phase.hpp"
#include "engine/store/rows.hpp"

#include <cstdint>
#include <span>

namespace lacuna {

// A candidate that has gap neighbours; without any it is none.
struct Candidate {
  Row row;
  Row gap_near, gap_far;
};

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
