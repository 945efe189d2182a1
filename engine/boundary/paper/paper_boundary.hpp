// SPDX-License-Identifier: Apache-2.0
// Boundary edges of the paper are the eligible edges of G. The spanning graph admits an edge within a tree
// only if it closes a long loop (paper, 5.1). Breadth-first search finds the loops in this graph (5.2).
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/paper/eligible_edges.hpp"
#include "engine/boundary/paper/raw_loops.hpp"
#include "engine/stitch/stitch.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"

#include <cstdint>
#include <optional>

namespace lacuna::paper {

// An edge out of the tile, to be decided once Pi of its foreign end is known.
struct UndecidedCrossing {
  Vertex own, foreign;
  Strength strength;  // of its own end
  double distance;
};

// An eligible edge between tiles, in the lists of both.
struct EligibleCrossing {
  LocalIndex owned;
  Vertex own, foreign;
  double weight;
};

// Each tile decides what it can: most edges, and the loops that lead to no other tile. It passes on the other
// edges. They are stitched by component, spanned again and searched. A component larger than memory is sorted
// on disk and spanned in mapped arrays.
class PaperBoundary final : public BoundaryMethod {
 public:
  PaperBoundary(const Tiling& tiling, const SpanningConfig& config, const Spill& spill,
                const Workers& workers);

  void emit(const EvaluatedTile& tile, TileOutput& output) const override;
  // Decides the edges between tiles, with Pi and r of both ends.
  void complete_edges(const TileOutputs& outputs) override;
  void stitch(const TileOutputs& outputs, const Totals& totals) override;
  FoundLoops find_loops(const TileOutputs& outputs) override;
  RowSet boundary_candidates(const TileOutputs&, const RowSet& coherent, const RowSet&) const override {
    return coherent;
  }

 private:
  void decide_crossings(const TileOutputs& outputs, TileIndex tile);
  void span_tile(const TileOutputs& outputs, TileIndex tile);

  const Tiling& tiling_;
  const SpanningConfig& config_;
  const Spill& spill_;
  const Workers& workers_;
  AppendLists<EligibleCrossing> crossings_;  // by tile
  Column<Strength> strengths_;               // by row, of points with foreign neighbours
  std::optional<Stitch<BoundaryEdge>> stitch_;
  RawLoops loops_;
  std::int64_t minimum_loop_ = 0;
  std::uint64_t edges_ = 0;
};

}  // namespace lacuna::paper
