// SPDX-License-Identifier: Apache-2.0
// chains: open chains of wedges, joined across tiles to closed curves (method.md, C.5).
#pragma once

#include "engine/boundary/tangential/curves.hpp"
#include "engine/stitch/stitch.hpp"
#include "engine/store/column.hpp"
#include "engine/store/scratch.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>

namespace lacuna::tangential {

// An end of a chain: its last point, and the other end of the boundary edge on which it leaves the tile.
struct ChainEnd {
  Row own, foreign;
};

// A chain's points lie one after the other in the column of all open chains.
struct OpenChain {
  std::uint64_t first, count;
  Scale scale;
  std::array<ChainEnd, 2> ends;  // of its first and of its last point
};

// Receives each closed curve of whole components, with arrays of its own.
using VisitCurve = std::function<void(std::span<const CurvePoint>, Scale, Scratch&)>;

// Closes the chains of whole components. Starts and directions of curves depend on the order of the chains.
// Their arrays live in `scratch`, and a sort takes half as much. Memory of a curve: `curve_budget` bytes, and
// temporary files beyond that. Cost: linear, and a sort of the chains' ends.
void close_chains(const Stitch<OpenChain>::ForEachRecord& for_each_chain, std::uint64_t count,
                  const Column<CurvePoint>& points, std::uint64_t curve_budget, Scratch& scratch,
                  const VisitCurve& visit);

}  // namespace lacuna::tangential
