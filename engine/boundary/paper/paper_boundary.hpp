// SPDX-License-Identifier: Apache-2.0
// paper_boundary: boundary edges of the paper are the eligible edges of G (paper, 5.1 and 5.2; method.md, B).
//
// Idea: edges between likely boundary points are eligible. The spanning graph admits an edge within a tree
// only if it closes a long loop (spanning.hpp). Breadth-first search finds the loops in this graph
// (loops.hpp). Each tile decides what it can: most edges, and the loops that lead to no other tile. It passes
// on the other edges. They are stitched by component, spanned again and searched. A component larger than
// memory is sorted on disk and spanned in mapped arrays.
//
// Source: the paper, 5.1 and 5.2. Cost: a sort of the eligible edges, and searches of a few steps for each.
#pragma once

#include "engine/boundary/boundary_method.hpp"
#include "engine/boundary/paper/loops.hpp"
#include "engine/config/config.hpp"
#include "engine/criteria/evaluation.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/stitch/stitch.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lacuna::paper {

// ---- Eligible edges: those of the proximity graph that may enter the spanning graph

// The values of one end of an edge on which the edge's weight depends.
struct Strength {
  double mean_distance;       // r_p
  float probability;          // Pi
  std::uint32_t padding = 0;  // zeros, so that every byte on disk is defined
};

// Returns w_total of an eligible edge: w_prob < max_prob_weight and w_total < max_total_weight. Returns a
// negative number if the edge is not eligible. Exact in double precision.
double eligible_weight(const Strength& a, const Strength& b, double distance, const SpanningConfig& config);

using TileEdge = WeightedEdge;  // between owned points

// An edge from an owned point to a foreign one whose Pi is not known yet.
struct Crossing {
  LocalIndex owned;
  LocalIndex foreign;
  double distance;
};

struct TileEdges {
  std::vector<TileEdge> inside;     // eligible, each edge once
  std::vector<Crossing> crossings;  // from owned points strong enough to make the edge eligible
};

// An edge is eligible only if one of its ends is strong: Pi > 1 - max_prob_weight / 2. So only the
// neighbours of strong points are compared, and the tile of each strong end reports an edge between tiles.
TileEdges eligible_edges(const TilePoints& points, const Neighbourhoods& neighbourhoods,
                         std::span<const Evaluation> evaluations, const SpanningConfig& config);
bool is_strong(double probability, const SpanningConfig& config);

// ---- The boundary

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
