// SPDX-License-Identifier: Apache-2.0
// figure_data K THRESHOLD < POINTS: what the plain method finds in a small scan, for the figures of
// docs/method.md, as JSON whose rows docs/figures/scans.py names. POINTS has x y z in a line. Candidates
// are above THRESHOLD, and are seeds. No normal is turned at a crease.
#include "tests/support/reference.cpp"

#include <iostream>
#include <string>

#include <nlohmann/json.hpp>

namespace lacuna::reference {
using nlohmann::json;

json of(const auto& points) {
  json ids = json::array();
  for (const PointId p : points) ids.push_back(value(p));
  return ids;
}

// The points of a level with their stars, and its boundary wedges within the fine bound.
json of(const Level& level, const Config& config, const Detection& result) {
  Stars stars(level.positions, config.tangential, result);
  const std::set<PointId> active = rough_points(result, config, stars);
  json points, wedges;
  for (const PointId p : result.distinct) {
    const Point& at = result.points[value(p)];
    const Star& star = stars[p];
    json link, radius, consistent;
    for (std::size_t i = 0; i < star.corners.size(); ++i) {
      link.push_back(value(star.corners[i].point));
      radius.push_back(star.corners[i].ball);
      consistent.push_back({is_agreed(p, i, active, stars, 0), is_agreed(p, i, active, stars, 1)});
    }
    points.push_back({level.positions[value(p)], of(at.neighbours), at.mean_distance, at.surface,
                      at.normal.value(), at.angle, at.halfdisc, at.lambda, at.probability, link, radius,
                      consistent, star.distance, star.radius});
    if (!active.contains(p)) continue;
    for (const Gap& gap : gaps_of(p, result, active, stars, 0, level.positions, config.tangential))
      wedges.push_back({value(gap.point), value(gap.from), value(gap.to)});
  }
  return {level.edge, points, of(active), wedges};
}

json figures(Level level, const Config& config) {
  Detection result = evaluated(level, config), paper = result;
  paper.e = std::llround(2 * std::sqrt(pi * paper.mean_neighbours));
  find_eligible(level.positions, config.spanning, paper);
  const Graph graph = span(paper);
  find_loops(graph, paper);
  json levels, found, rows, eligible, closed;
  for (const auto& row : graph) rows.push_back(of(row));
  for (const auto& loop : paper.loops) closed.push_back(of(loop));
  for (const Edge& edge : paper.eligible) eligible.push_back({value(edge.low), value(edge.high)});

  Loops loops;
  std::vector<double> edges, cells;
  for (std::optional<Level> next = level; next; next = level_above(level, result)) {
    level = *std::move(next);
    result = evaluated(level, config);
    for (FoundLoop loop : loops_of(level, edges.size(), config, result)) {
      loop.log_odds = own_log_odds(loop, level.positions);
      loops.push_back(loop);
    }
    edges.push_back(level.edge);
    cells.push_back(level.edge > 0 ? level.edge : median_distance(result) / 1.7);
    levels.push_back(of(level, config, result));
  }
  const Tracked tracked = track(loops, edges, cells);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const FoundLoop& loop = loops[i];
    found.push_back({of(loop.points), loop.level, loop.scale, loop.clearness, loop.surface, tracked.odds[i],
                     tracked.ranks[i], tracked.chosen.contains(i)});
  }
  return {levels, found, paper.e, eligible, rows, closed};
}

}  // namespace lacuna::reference

int main(int count, char** arguments) {
  if (count != 3) return 2;
  lacuna::Config config;
  config.neighbourhood.k = std::stoi(arguments[1]);
  config.coherence.threshold = config.tangential.seed_probability = std::stod(arguments[2]);
  config.normals.crease_threshold = 1;
  lacuna::reference::Level level;
  for (Eigen::Vector3d p; std::cin >> p.x() >> p.y() >> p.z(); level.positions.push_back(p))
    level.names.push_back(lacuna::PointId{level.names.size()});
  std::cout << lacuna::reference::figures(level, config);
}
