// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/measure_loops.hpp"

#include "engine/loops/measure_loop.hpp"

#include <cmath>
#include <utility>

namespace lacuna {
namespace {

// Cubes of 64 mean edges, as a power of two.
double lattice_edge(double mean_edge_length) {
  return std::ldexp(1.0, std::ilogb(64 * mean_edge_length));
}

}  // namespace

MeasuredLoops measure_loops(ChosenLoops loops, std::span<const LoopTrack> tracks, double mean_edge_length,
                            const Spill& spill, const Workers& workers, Phases& phases) {
  Phase phase(phases, "measure", loops.points());
  std::vector<LoopMeasures> measures(loops.size());
  const double edge = lattice_edge(mean_edge_length);
  for_each_loop(loops, spill, workers, [&](std::size_t i, std::span<const LoopPoint> loop, Scratch& scratch) {
    measures[i] = measure_loop(loop, edge, scratch);
    measures[i].track = tracks[i];
    phase.advance(loop.size());
  });
  return {std::move(loops), std::move(measures)};
}

std::vector<std::size_t> select_loops(const std::vector<LoopMeasures>& loops, const SelectionConfig& config) {
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const LoopMeasures& loop = loops[i];
    const bool too_short = loop.perimeter < config.min_perimeter;
    const bool too_long = config.max_perimeter > 0 && loop.perimeter > config.max_perimeter;
    const bool too_small = loop.diameter < config.min_diameter || loop.area < config.min_area;
    const bool too_large = config.max_area > 0 && loop.area > config.max_area;
    const bool too_few = loop.points < static_cast<std::uint64_t>(config.min_points);
    const bool unwanted = config.holes_only && loop.kind == LoopKind::kOuter;
    if (!too_short && !too_long && !too_small && !too_large && !too_few && !unwanted) selected.push_back(i);
  }
  return selected;
}

}  // namespace lacuna
