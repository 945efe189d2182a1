// SPDX-License-Identifier: Apache-2.0
// track_loops: follows the same hole through the levels, and chooses one of its loops (method.md, D.2 and
// D.4).
//
// Idea: loops of neighbouring levels are drawn in the cells of one lattice, the lattice of the coarser level.
// A cell is near a loop if it or one of the 26 cells around it is a cell of that loop. The fractions of near
// cells say how much two loops have in common. They are ratios of whole numbers, so neither order nor
// rounding matters.
//
// Source: method.md, D. Cost: a sort of the loops' cells on disk, and passes over the pairs in memory.
#pragma once

#include "engine/config/job.hpp"
#include "engine/evaluate/totals.hpp"
#include "engine/loops/loops.hpp"
#include "engine/run/parallel.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {

struct LevelLoops {
  double edge = 0;           // of the level's lattice; 0: every point
  double cell_edge = 0;      // of the lattice on which its loops are compared with others
  std::uint64_t points = 0;  // distinct ones of the level
  double surface_area = 0;   // as its points sample it; 0 where they are too few
  Loops loops;
};

// `edge`: of the level's lattice; 0: it has every point. `far`: where far distances to neighbours begin at the
// first level. A lattice whose neighbours are as far keeps points in the air rather than a surface.
inline LevelLoops level_loops(Loops loops, double edge, const Totals& totals, double far) {
  constexpr double kNear = 4 * kDistanceOverSpacing;
  return {.edge = edge,
          .cell_edge = edge > 0 ? edge : totals.median_distance() / kDistanceOverSpacing,
          .points = totals.points,
          .surface_area = kNear * edge < far ? totals.surface_area(far) : 0,
          .loops = std::move(loops)};
}

// ---- Which loops run along each other

// A hole may be missing at up to this many levels between two levels at which it is found.
inline constexpr std::size_t kBridged = 1;

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

// ---- Which of them are chosen

// The chosen loops, and what tracking found of each.
struct TrackedLoops {
  ChosenLoops loops;
  std::vector<LoopTrack> tracks;
};

// Returns the chosen loop of each hole, if its confidence is at least the selection's. select_loops applies
// the other limits. `levels`: from fine to coarse. The choice does not depend on what is wanted, so a higher
// confidence gives a subset. All loops of the paper, which has one level, are chosen. Cost: a sort of the
// loops' cells on disk.
TrackedLoops track_loops(std::vector<LevelLoops> levels, Job& job);

}  // namespace lacuna
