// SPDX-License-Identifier: Apache-2.0
// The results of a tile's evaluation, and the consumers that take them.
#pragma once

#include "engine/criteria/evaluation.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/model/boundary_graph.hpp"
#include "engine/model/neighbourhoods.hpp"
#include "engine/model/points.hpp"
#include "engine/model/tiling.hpp"

#include <cstdint>
#include <functional>
#include <span>

namespace lacuna {

struct EvaluatedTile {
  TileIndex index;
  const Tile& tile;
  const TilePoints& points;
  const Neighbourhoods& neighbourhoods;     // of owned points
  std::span<const Evaluation> evaluations;  // of owned points
  std::span<const double> criteria;         // of owned points, in the order of the table; empty: not wanted
  std::span<const LocalIndex> candidates;   // owned points with Pi above the threshold, ascending
  std::span<const std::uint8_t> is_border;  // of owned points: has foreign neighbours

  Vertex vertex(LocalIndex p) const { return {points.ids[p], points.rows[p]}; }
  ScanPoint point(LocalIndex p) const { return ScanPoint::at(points.positions[p], points.ids[p]); }
  float probability(LocalIndex p) const { return static_cast<float>(evaluations[p].probability); }
};

// Puts the data that a later step needs of an evaluated tile into its output. Called from several threads at
// once, for tiles in any order.
using TileConsumer = std::function<void(const EvaluatedTile& tile, TileOutput& output)>;

}  // namespace lacuna
