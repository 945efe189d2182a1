// SPDX-License-Identifier: Apache-2.0
#include "engine/summarise.hpp"

#include "engine/bucket/strays.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace lacuna {
namespace {

// Fine levels see lines of points rather than a surface, or noise; coarse ones cross its holes.
double median_area(std::span<const LevelLoops> levels) {
  std::vector<double> areas;
  for (const LevelLoops& level : levels)
    if (level.surface_area > 0) areas.push_back(level.surface_area);
  if (areas.empty()) return 0;
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>((areas.size() - 1) / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return *middle;
}

// Along a line, half as many cells have points where their edge doubles; on a surface, a quarter.
bool are_lines(std::span<const LevelSummary> levels) {
  constexpr double kMostDimension = 1.4;
  const auto first = std::ranges::find_if(levels, [](const LevelSummary& level) { return level.edge > 0; });
  if (levels.end() - first < 2) return false;
  const LevelSummary& last = levels.back();
  return std::log(static_cast<double>(first->points) / static_cast<double>(last.points)) <
         kMostDimension * std::log(last.edge / first->edge);
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

ScanShape shape_of(const Summary& summary) {
  constexpr double kSurface = 0.9, kLeastNeighbours = 4;
  if (summary.mean_neighbours < kLeastNeighbours) return ScanShape::kTooFewNeighbours;
  if (are_lines(summary.levels)) return ScanShape::kLines;
  // On a thin surface, all levels have the area that follows from the distances of the first one. Points that
  // fill a volume, or lie in layers, have less of it at coarse levels.
  const double points = summary.levels.empty() ? 0 : static_cast<double>(summary.levels.front().points);
  const double distance = summary.median_distance;
  const double area =
      2.25 * std::numbers::pi * points * distance * distance / (summary.mean_neighbours + 2.5);
  return summary.surface_area > kSurface * area ? ScanShape::kSurface : ScanShape::kNoSurface;
}

}  // namespace lacuna
