// SPDX-License-Identifier: Apache-2.0
#include "engine/thin/thin.hpp"

#include "engine/bucket/tile_size.hpp"
#include "engine/run/error.hpp"
#include "engine/thin/store_chosen.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

namespace lacuna {
namespace {

// Makes a level of the chosen points.
Level level_of(ChosenPoints chosen, const Level& below, std::size_t number, double edge, std::size_t tasks,
               StoreFiles files, Job& job) {
  const std::uint64_t about = chosen.count * tasks;  // of the level
  const TileJoin join =
      join_tiles(below.store.tiling(), chosen, points_per_tile(about, job.config, job.workers),
                 points_per_cell(about, job.workers.memory));
  return {.number = number,
          .edge = edge,
          .survey = below.survey,
          .extent = below.extent,
          .tile_points = join.tile_points,
          .store = store_chosen(below.store, chosen, join, std::move(files), job.workers),
          .input = below.input,
          .represented = std::move(chosen.represented)};
}

// Cells as large as the scan leave too few points to have neighbours. A scan of few points, or of one place,
// has no more points at any resolution.
void refuse_too_coarse(std::uint64_t left, const SurveyTotals& survey, const Config& config) {
  const std::uint64_t finite = survey.points - survey.dropped;
  const auto k = static_cast<std::uint64_t>(config.neighbourhood.k);
  const Eigen::Vector3d size = Eigen::AlignedBox3d(survey.bounds).sizes();
  if (left > k || finite <= k || size.isZero(0)) return;
  const ScaleConfig& scale = config.scale;
  const bool is_of_hole = scale.resolution == 0;
  std::ostringstream message;
  message << "a resolution of " << first_edge(scale);
  if (is_of_hole) message << ", for holes of " << scale.min_hole << ",";
  message << " leaves " << left << " of " << finite << " points, too few for k = " << k
          << " neighbours; the scan's size is " << size.x() << " x " << size.y() << " x " << size.z()
          << "; allowed: a smaller " << (is_of_hole ? "--min-hole" : "--resolution");
  throw Error(message.str());
}

// Returns the first power of sqrt 2 above a length.
double power_above(double length) {
  const double octave = std::ldexp(1.0, std::ilogb(length));
  return octave * std::numbers::sqrt2 > length ? octave * std::numbers::sqrt2 : 2 * octave;
}

// Returns the share of the points that cells of this edge leave. Where a cell of a surface has n points on
// average, the share is about 1 / (1 + n / 2).
double share_left(const LengthBins& distances, double edge) {
  constexpr double kCellsOfSurface = 1.3;  // to cover one cell's area, as surfaces are tilted
  double left = 0, all = 0;
  for (const auto& [bin, count] : distances.counts) {
    const double cells_per_spacing = edge * kDistanceOverSpacing / LengthBins::start_of(bin);
    left += static_cast<double>(count) / (1 + cells_per_spacing * cells_per_spacing / kCellsOfSurface / 2);
    all += static_cast<double>(count);
  }
  return left / all;
}

}  // namespace

Level thin_to_first(const Level& all, StoreFiles files, Job& job) {
  Phase phase(job.phases, "thin", all.store.tiling().points());
  const double edge = first_edge(job.config.scale);
  const std::uint64_t represented_ids = job.config.results.points ? all.survey.ids : 0;
  ChosenPoints chosen = choose_points(all.store, all.store.tiling().tiles_in({}), edge, represented_ids,
                                      job.spill, job.workers);
  refuse_too_coarse(chosen.count, all.survey, job.config);
  return level_of(std::move(chosen), all, 0, edge, 1, std::move(files), job);
}

double edge_above(const Level& below, const LengthBins& distances) {
  constexpr double kWantedLeft = 0.6;
  if (distances.counts.empty()) return 0;
  const double least = LengthBins::start_of(distances.counts.begin()->first) / 4;
  double edge = power_above(std::max(below.edge * 1.0001, least));  // edges are rounded powers
  while (share_left(distances, edge) > kWantedLeft) edge = power_above(edge * 1.0001);
  return edge;
}

Level thin_above(const Level& below, const TaskShare& share, double edge, StoreFiles files, Job& job) {
  ChosenPoints chosen =
      choose_points(below.store, below.store.tiling().tiles_in(share), edge, 0, job.spill, job.workers);
  return level_of(std::move(chosen), below, below.number + 1, edge, share.tasks, std::move(files), job);
}

bool has_levels(const Config& config) {
  const ScaleConfig& scale = config.scale;
  return config.loops.method == LoopMethod::kTangential && !scale.every_point && scale.resolution == 0;
}

}  // namespace lacuna
