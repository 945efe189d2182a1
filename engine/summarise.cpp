// SPDX-License-Identifier: Apache-2.0
#include "engine/summarise.hpp"

#include "engine/bucket/strays.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lacuna {
namespace {

// Fine levels see lines of points rather than a surface, or noise; coarse ones cross its holes.
double median_area(std::span<const LevelLoops> levels) {
  std::vector<double> areas;
  for (const LevelLoops& level : levels) areas.push_back(level.surface_area);
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>((areas.size() - 1) / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return *middle;
}

}  // namespace

Summary summarise(const Level& level, const Workers& workers) {
  const SurveyTotals& survey = level.survey;
  const TileStore& store = level.store;
  Summary summary;
  summary.counts.points = survey.points;
  summary.counts.dropped = survey.dropped;
  summary.bounds = survey.bounds;
  summary.resolution = level.edge;
  if (level.edge > 0) summary.counts.thinned_out = survey.points - survey.dropped - store.tiling().points();
  summary.strays = find_strays(store);
  if (summary.strays.points == 0) summary.strays.rest = summary.bounds;
  summary.tiles = store.tiling().tiles.size();
  summary.tile_points = level.tile_points;
  summary.threads = workers.arena.threads();
  summary.memory_limit = workers.memory.limit;
  return summary;
}

void add_findings(const Totals& totals, const FoundLoops& found, std::span<const LevelLoops> levels,
                  double eps, Summary& summary) {
  Counts& counts = summary.counts;
  counts.duplicates = counts.points - counts.dropped - counts.thinned_out - totals.points;
  counts.candidates = totals.candidates;
  counts.undefined_normals = totals.undefined_normals;
  counts.normals_off = totals.normals_off;
  counts.boundary_edges = found.edges;
  counts.components = found.components;
  for (const LevelLoops& level : levels) {
    counts.raw_loops += level.loops.size();
    summary.levels.push_back({level.edge, level.points, level.loops.size()});
  }
  summary.mean_neighbours = totals.mean_neighbours();
  summary.mean_edge_length = totals.mean_edge_length();
  summary.median_distance = totals.median_distance();
  summary.probabilities = totals.probabilities;
  summary.surface_area = median_area(levels);
  summary.eps = eps;
  summary.e = found.minimum_loop;
}

}  // namespace lacuna
