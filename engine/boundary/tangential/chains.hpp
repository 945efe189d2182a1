// SPDX-License-Identifier: Apache-2.0
// chains: open chains of wedges, joined across tiles to closed curves (method.md, C.5).
#pragma once

#include "engine/boundary/tangential/curves.hpp"
#include "engine/stitch/stitch.hpp"
#include "engine/store/column.hpp"
#include "engine/store/scratch.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
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

// Starts and directions of curves depend on the order of `chains`. Memory: `budget` bytes for the arrays of a
// curve, and temporary files beyond that. Cost: linear, and a sort of the chains' ends.
void close_chains(std::span<const OpenChain> chains, const Column<CurvePoint>& points,
                  const std::filesystem::path& temporary, std::uint64_t budget, const VisitCurve& visit);

// Closes the chains of a component that do not fit in memory. It sorts them on disk and follows them in
// mapped arrays. Memory: three times the budget.
void close_many_chains(const Stitch<OpenChain>::ForEachRecord& for_each_chain, std::uint64_t count,
                       const Column<CurvePoint>& points, const std::filesystem::path& temporary,
                       std::uint64_t budget, const VisitCurve& visit);

}  // namespace lacuna::tangential
