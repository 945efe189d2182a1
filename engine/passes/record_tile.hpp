// What is kept of a tile once it is evaluated.
#pragma once

#include "engine/data/evaluation.hpp"
#include "engine/data/neighbourhoods.hpp"
#include "engine/passes/evaluate.hpp"

#include <vector>

namespace lacuna {

struct EvaluatedTile {
  TileIndex index;
  const TilePoints& points;
  const Rows& neighbourhoods;
  const std::vector<Evaluation>& evaluations;  // of owned points
};

struct TileNumbers {
  Totals totals;
  std::vector<TileIndex> leans_on;  // tiles that own gap neighbours of this one's candidates
};

// Finds the tile's stars (loops by stars) or its eligible edges (by the paper), and appends these, vertices,
// candidates and what else was asked for to the lists of the scan. Tiles may be recorded side by side.
TileNumbers record_tile(const EvaluatedTile& tile, EvaluatedScan& scan, const TileStore& store,
                        const Job& job);

}  // namespace lacuna
