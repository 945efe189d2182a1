// SPDX-License-Identifier: Apache-2.0
// near_loops: finds loops of neighbouring levels that run along each other.
//
// Both loops are drawn in the cells of one lattice, the lattice of the coarser level. A cell is near a loop
// if it or one of the 26 cells around it is a cell of that loop. The fractions of near cells say how much the
// loops have in common. They are ratios of whole numbers, so neither order nor rounding matters.
#pragma once

#include "engine/run/parallel.hpp"
#include "engine/track/level_loops.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

// Loops are numbered level by level, from the finest on.
struct NearLoops {
  std::uint32_t a, b;  // a < b
  float of_a, of_b;    // fraction of the cells of one that are near the other, [0, 1]

  bool is_same_hole() const {
    constexpr float kSame = 0.7f;
    return of_a >= kSame && of_b >= kSame;
  }

  friend bool operator<(const NearLoops& x, const NearLoops& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }
};

// Returns pairs of loops of one level, or of two that are at most `kBridged` + 1 apart. One of the two has at
// least half of its cells near the other. Pairs ascend. Cost: a sort of the loops' cells on disk.
std::vector<NearLoops> near_loops(std::span<const LevelLoops> levels, const Spill& spill,
                                  const Workers& workers);

// A hole may be missing at up to this many levels between two levels at which it is found.
inline constexpr std::size_t kBridged = 1;

}  // namespace lacuna
