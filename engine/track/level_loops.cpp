// SPDX-License-Identifier: Apache-2.0
#include "engine/track/level_loops.hpp"

#include <utility>

namespace lacuna {

LevelLoops level_loops(const Level& level, const Totals& totals, const FoundLoops& found,
                       const BoundaryMethod& boundary, Job& job) {
  LevelLoops loops{.edge = level.edge,
                   .cell_edge = level.edge > 0 ? level.edge : totals.median_distance() / kDistanceOverSpacing,
                   .points = totals.points,
                   .surface_area = totals.surface_area(),
                   .loops = place_loops(found.loops, boundary.loop_points(), level.store.tiling(), job),
                   .evidence = {}};
  for (std::size_t i = 0; i < found.loops.size(); ++i) loops.evidence.push_back(found.loops.evidence(i));
  return loops;
}

}  // namespace lacuna
