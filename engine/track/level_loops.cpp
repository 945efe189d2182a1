// SPDX-License-Identifier: Apache-2.0
#include "engine/track/level_loops.hpp"

#include <utility>

namespace lacuna {

LevelLoops level_loops(Loops loops, double edge, const Totals& totals) {
  return {.edge = edge,
          .cell_edge = edge > 0 ? edge : totals.median_distance() / kDistanceOverSpacing,
          .points = totals.points,
          .surface_area = totals.surface_area(),
          .loops = std::move(loops)};
}

}  // namespace lacuna
