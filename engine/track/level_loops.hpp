// SPDX-License-Identifier: Apache-2.0
// The loops of one level, as tracking takes them.
#pragma once

#include "engine/evaluate/totals.hpp"
#include "engine/loops/loops.hpp"

#include <cstdint>
#include <utility>

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

}  // namespace lacuna
