// SPDX-License-Identifier: Apache-2.0
#include "engine/levels/level.hpp"

#include "engine/bucket/bucket_scan.hpp"
#include "engine/bucket/split.hpp"
#include "engine/halo/eps_balls.hpp"
#include "engine/levels/sealed_level.hpp"
#include "engine/run/disk_space.hpp"
#include "engine/run/error.hpp"
#include "engine/store/kept_scan.hpp"
#include "engine/survey/survey_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

namespace lacuna {
namespace {

// Raw points of tiles are all written. Those that are set aside may be copies of a few.
std::uint64_t least_store_bytes(const TilePlan& plan, Precision precision) {
  std::uint64_t points = 0;
  for (const Tile& tile : plan.tiles) points += tile.raw;
  return points * (precision == Precision::kSingle ? sizeof(StoredPoint) / 2 : sizeof(StoredPoint));
}

// As the run before an update has cut the level, if that suits this one.
std::optional<TileGuide> usable_guide(const Job& job) {
  std::optional<TileGuide> guide = find_guide(job);
  if (guide && job.tile_bytes(2 * guide->tile_points) > job.memory.tiles) guide.reset();
  return guide;
}

Level bucket_points(PointSource& scan, StoreFiles files, Job& job) {
  std::optional<TileGuide> guide = usable_guide(job);
  SurveyedScan survey = survey_scan(scan, job, guide ? &guide->grid : nullptr);
  if (guide && survey.grid.shift != guide->grid.shift) guide.reset();
  const std::uint64_t points = survey.points - survey.dropped;
  const std::uint64_t tile_points = guide ? guide->tile_points : job.tile_points(points);
  TilePlan plan =
      split_tiles(std::move(survey.cells), survey.grid, points, tile_points, guide ? &*guide : nullptr);
  plan.cell_points = guide ? guide->cell_points : job.cell_points(points);
  require_space(job.workspace, least_store_bytes(plan, survey.precision()));
  Level level{
      .guide = {survey.grid, plan.cuts, tile_points, plan.cell_points},
      .store = bucket_scan(scan, std::move(plan), survey.bounds, survey.precision(), std::move(files), job),
      .represented = {}};
  level.survey = std::move(survey);
  level.extent = extent_of(level.survey.bounds);
  return level;
}

// As the tiles were put together before an update, if that suits these points.
TileJoin join_for(std::size_t number, const Tiling& below, const ChosenPoints& chosen, const Job& job) {
  std::optional<TileJoin> join = find_join(number, job);
  if (join && job.tile_bytes(2 * join->tile_points) <= job.memory.tiles && suits(*join, below, chosen))
    return *std::move(join);
  return join_tiles(below, chosen, job.tile_points(chosen.count), job.cell_points(chosen.count));
}

// The chosen points as a level.
Level level_of(ChosenPoints chosen, const Level& below, std::size_t number, double edge, Job& job) {
  TileJoin join = join_for(number, below.store.tiling(), chosen, job);
  return {.number = number,
          .edge = edge,
          .survey = below.survey,
          .extent = below.extent,
          .guide = below.guide,
          .join = join,
          .store = store_chosen(below.store, chosen, join, level_files(number, job), job),
          .represented = std::move(chosen.represented)};
}

// Cells as large as the scan leave too few points to have neighbours. A scan of few points, or of one place,
// has no more at any resolution.
void refuse_too_coarse(std::uint64_t left, const SurveyedScan& survey, const Config& config) {
  const std::uint64_t finite = survey.points - survey.dropped;
  const auto k = static_cast<std::uint64_t>(config.neighbourhood.k);
  if (left > k || finite <= k || survey.bounds.sizes().isZero(0)) return;
  const Eigen::Vector3d size = survey.bounds.sizes();
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

// The first power of sqrt 2 above a length.
double power_above(double length) {
  const double octave = std::ldexp(1.0, std::ilogb(length));
  return octave * std::numbers::sqrt2 > length ? octave * std::numbers::sqrt2 : 2 * octave;
}

// The share of the points that cells of this edge leave. Where a cell of a surface has n points on average,
// that is about 1 / (1 + n / 2).
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

constexpr double kWantedLeft = 0.6, kMostLeft = 0.9;

// The first edge above a length that leaves as few points as a level is to have; 0 where no point has a
// neighbour.
double edge_above(const LengthBins& distances, double length) {
  if (distances.counts.empty()) return 0;
  double edge = power_above(std::max(length, LengthBins::start_of(distances.counts.begin()->first) / 4));
  while (share_left(distances, edge) > kWantedLeft) edge = power_above(edge * 1.0001);
  return edge;
}

Level read_first_level(PointSource& input, Job& job) {
  if (input.reads_slowly()) {
    KeptScan kept(input, job.file("input"));
    return read_first_level(kept, job);
  }
  const double edge = first_edge(job.config.scale);
  if (edge == 0) return bucket_points(input, level_files(0, job), job);
  const Level all = bucket_points(input, temporary_files(job), job);
  Phase phase(job, "thin", all.store.tiling().points());
  ChosenPoints chosen = choose_points(all.store, edge, job.config.results.points ? all.survey.ids : 0, job);
  refuse_too_coarse(chosen.count, all.survey, job.config);
  return level_of(std::move(chosen), all, 0, edge, job);
}

std::optional<Level> thin_level(const Level& below, const Totals& totals, Job& job) {
  constexpr std::uint64_t kFewest = 200;  // points: fewer leave no interior around a hole
  const std::uint64_t points = below.store.tiling().points();
  // Edges are rounded powers.
  for (double edge = edge_above(totals.distances, below.edge * 1.0001); edge > 0;
       edge = power_above(edge * 1.0001)) {
    ChosenPoints chosen = choose_points(below.store, edge, 0, job);
    if (chosen.count < kFewest) break;
    if (static_cast<double>(chosen.count) <= kMostLeft * static_cast<double>(points))
      return level_of(std::move(chosen), below, below.number + 1, edge, job);
  }
  return std::nullopt;
}

}  // namespace

Level first_level(PointSource& input, Job& job) {
  if (std::optional<Level> kept = open_level(0, job.made_from, job)) {
    input.set_pass_counts(kept->input);
    return *std::move(kept);
  }
  Level level = read_first_level(input, job);
  level.input = input.pass_counts();
  seal_level(level, job.made_from, job);
  return level;
}

std::optional<Level> level_above(const Level& below, const Totals& totals, Job& job) {
  if (std::optional<Level> kept = open_level(below.number + 1, below.evaluation, job)) return kept;
  std::optional<Level> level = thin_level(below, totals, job);
  if (!level) return std::nullopt;
  seal_level(*level, below.evaluation, job);
  return level;
}

bool has_levels(const Config& config) {
  const ScaleConfig& scale = config.scale;
  return config.loops.method == LoopMethod::kTangential && !scale.every_point && scale.resolution == 0;
}

std::uint64_t points_above(const Level& first) {
  return 2 * first.store.tiling().points();  // each has half of the points of the one below
}

}  // namespace lacuna
