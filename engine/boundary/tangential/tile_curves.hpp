// SPDX-License-Identifier: Apache-2.0
// tile_curves: the curves of one tile. Most curves close within a tile, and most of them are gaps of the
// sampling. So a tile follows its wedges as soon as it knows them, and keeps loops and open chains alone.
#pragma once

#include "engine/boundary/tangential/chains.hpp"
#include "engine/boundary/tangential/curves.hpp"
#include "engine/evaluate/tile_outputs.hpp"
#include "engine/loops/loops.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna::tangential {

struct CurveTotals {
  std::uint64_t edges = 0;       // of the boundary graph, within the fine bound
  std::uint64_t components = 0;  // of the boundary graph, of which no chain is open
};

// Chains that leave the wedges of a tile, and what else these wedges are.
struct OpenChains {
  std::vector<OpenChain> chains;       // `first`: among `points`
  std::vector<LocalIndex> components;  // of each chain: 0, 1, 2 ... in the order of their first chains
  std::vector<CurvePoint> points;
  CurveTotals totals;

  void emit(TileOutput& output) &&;
  static OpenChains read(const TileOutputs& outputs, TileIndex tile);
  static std::uint64_t bytes(const TileOutputs& outputs, TileIndex tile);  // that `read` returns
};

// Follows wedges to curves. `wedges`: of some points of a tile, all wedges of each point, in ascending row.
// point_of(i): the curve point of wedge i. Calls visit(curve, scale) for each closed curve. Cost: linear.
OpenChains follow_curves(std::span<const Wedge> wedges,
                         const std::function<CurvePoint(std::uint64_t)>& point_of,
                         const std::function<void(std::span<const CurveStep>, Scale)>& visit);

// Loops that close within a tile.
struct TileLoops {
  struct Entry {
    std::uint64_t points;
    LoopEvidence evidence;
  };
  std::vector<Entry> loops;
  std::vector<LoopPoint> points;  // of one loop after the other

  void emit(TileOutput& output) &&;
  static TileLoops read(const TileOutputs& outputs, TileIndex tile);
  static std::uint64_t bytes(const TileOutputs& outputs, TileIndex tile);  // that `read` returns
};

}  // namespace lacuna::tangential
