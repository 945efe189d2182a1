// SPDX-License-Identifier: Apache-2.0
// eligible_edges: finds which edges of the proximity graph may enter the spanning graph (paper, 5.1).
#pragma once

#include "engine/config/config.hpp"
#include "engine/criteria/evaluation.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/model/neighbourhoods.hpp"

#include <span>
#include <vector>

namespace lacuna::paper {

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

}  // namespace lacuna::paper
