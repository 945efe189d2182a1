// SPDX-License-Identifier: Apache-2.0
// order_edges: the order in which the spanning graph takes its edges (paper, 5.1).
#pragma once

#include "engine/model/boundary_graph.hpp"

#include <span>
#include <vector>

namespace lacuna::paper {

// Sorts the edges ascending by (weight, lower id, higher id). Weights: multiples of kProbabilityStep, at
// least 0 and at most 1e9. `ids`: the id of each vertex. Cost: linear except for edges of equal weight; as
// much memory again.
void order_edges(std::vector<WeightedEdge>& edges, std::span<const PointId> ids);

}  // namespace lacuna::paper
