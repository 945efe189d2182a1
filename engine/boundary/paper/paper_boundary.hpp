// SPDX-License-Identifier: Apache-2.0
// Boundary edges of the paper are the eligible edges of G. The spanning graph admits those that close long
// loops only (paper, 5.1). Loops are found in it by breadth-first search (5.2).
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/paper/eligible_edges.hpp"
#include "engine/stitch/stitch.hpp"
#include "engine/store/tile_store.hpp"

#include <cstdint>

namespace lacuna::paper {

// An edge out of the tile, to be decided once Pi of its foreign end is known.
struct StoredCrossing {
  Vertex own, foreign;
  Strength strength;  // of its own end
  double distance;
};
template <class Visit>
void for_each_row(StoredCrossing& record, Visit&& visit) {
  visit(record.own.row);
  visit(record.foreign.row);
}

// An eligible edge between tiles, in the lists of both.
struct EligibleCrossing {
  LocalIndex owned;
  Vertex own, foreign;
  double weight;
};

// Each tile decides what it can: most edges, and the loops that lead to no other tile. What it passes on is
// stitched by component, spanned again and searched. A component larger than memory is sorted on disk and
// spanned in mapped arrays.
class PaperBoundary final : public BoundaryMethod {
 public:
  PaperBoundary(const TileStore& store, const Job& job);

  void emit(const EvaluatedTile& tile, TileOutput& output) const override;
  void absorb(TileIndex tile, const TileOutput& output) override;
  FoundLoops find_loops(const Totals& totals, Job& job) override;
  // The coherent ones.
  RowSet boundary_candidates(const Candidates&, const RowSet& coherent, const RowSet&, Job&) const override {
    return coherent;
  }

 private:
  void decide_crossings(TileIndex tile);
  void span_tile(TileIndex tile, std::int64_t e, Stitch<BoundaryEdge>& stitch, FoundLoops& found, Job& job);

  const Tiling& tiling_;
  AppendLists<TileEdge> inside_;             // eligible ones, by tile
  AppendLists<StoredCrossing> undecided_;    // by tile
  AppendLists<EligibleCrossing> crossings_;  // by tile
  Column<Strength> strengths_;               // by row, of points with foreign neighbours
  const SpanningConfig& config_;
};

}  // namespace lacuna::paper
