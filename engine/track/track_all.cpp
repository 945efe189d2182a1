// SPDX-License-Identifier: Apache-2.0
#include "engine/track/track_all.hpp"

#include "engine/loops/measure_loop.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lacuna {
namespace {

// Makes a track for each loop, with this loop as its only one.
std::vector<TrackedLoop> loops_of(std::span<const LevelLoops> levels) {
  std::vector<TrackedLoop> loops;
  for (std::uint32_t l = 0; l < levels.size(); ++l) {
    for (std::uint32_t i = 0; i < levels[l].loops.size(); ++i) {
      const LoopEvidence& e = levels[l].loops.evidence(i);
      loops.push_back({.level = l,
                       .loop = i,
                       .first = l,
                       .last = l,
                       .evidence = {.clearness = e.clearness,
                                    .surface = e.surface,
                                    .sampling_gap = e.sampling_gap,
                                    .best = e.clearness * e.surface,
                                    .is_first_level = l == 0}});
    }
  }
  return loops;
}

// Follows each hole up to its last level, and down to its first one. Pairs and their levels ascend, so each
// way takes one pass.
void follow(std::span<const NearLoops> pairs, std::vector<TrackedLoop>& loops) {
  std::vector<double> above(loops.size()), below(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) above[i] = below[i] = loops[i].evidence.best;
  const auto is_link = [&](const NearLoops& p) {
    return p.is_same_hole() && loops[p.a].level != loops[p.b].level;
  };
  for (std::size_t i = pairs.size(); i-- > 0;) {
    const auto& [a, b, of_a, of_b] = pairs[i];
    if (!is_link(pairs[i])) continue;
    above[a] = std::max(above[a], above[b]);
    loops[a].last = std::max(loops[a].last, loops[b].last);
  }
  std::vector<NearLoops> upward;  // by the upper loop
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(upward), is_link);
  std::sort(upward.begin(), upward.end(),
            [](const NearLoops& x, const NearLoops& y) { return x.b != y.b ? x.b < y.b : x.a < y.a; });
  for (const auto& [a, b, of_a, of_b] : upward) {
    below[b] = std::max(below[b], below[a]);
    loops[b].first = std::min(loops[b].first, loops[a].first);
  }
  for (std::size_t i = 0; i < loops.size(); ++i) loops[i].evidence.best = std::max(above[i], below[i]);
}

// Returns the logarithm to the base 2, by straight lines between powers of two: within 0.09, and the same on
// every machine.
double octaves(double ratio) {
  const int power = std::ilogb(ratio);
  return power + std::ldexp(ratio, -power) - 1;
}

// 0: the track ends at all points, or before the spacing.
double persistence(double last_edge, double spacing) {
  return last_edge > spacing ? octaves(last_edge / spacing) : 0;
}

// Adds what depends on the loop's shape and on the last level of its track, and the odds.
void rate(std::span<const LevelLoops> levels, std::vector<TrackedLoop>& loops, Job& job) {
  std::size_t first = 0;
  for (const LevelLoops& level : levels) {
    for_each_loop(level.loops, job,
                  [&](std::size_t i, std::span<const StoredLoopPoint> points, Scratch& scratch) {
                    TrackedLoop& loop = loops[first + i];
                    const double spacing = level.loops.evidence(i).spacing;
                    const auto [perimeter, area] = shape_of(points, scratch);
                    loop.evidence.width = 2 * area / perimeter / spacing;
                    loop.evidence.roundness = roundness(perimeter, area, loop.evidence.width);
                    loop.evidence.persistence = persistence(levels[loop.last].edge, spacing);
                    loop.log_odds = log_odds(loop.evidence);
                  });
    first += level.loops.size();
  }
}

}  // namespace

std::vector<TrackedLoop> track_all(std::span<const LevelLoops> levels, std::span<const NearLoops> pairs,
                                   Job& job) {
  std::vector<TrackedLoop> loops = loops_of(levels);
  follow(pairs, loops);
  rate(levels, loops, job);
  return loops;
}

}  // namespace lacuna
