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

Level bucket_points(PointSource& scan, std::size_t number, Job& job) {
  SurveyedScan survey = survey_scan(scan, job);
  const std::uint64_t points = survey.points - survey.dropped, tile_points = job.tile_points(points);
  TilePlan plan = split_tiles(std::move(survey.cells), survey.grid, points, tile_points);
  require_space(job.workspace, least_store_bytes(plan, survey.precision()));
  TileStore store =
      bucket_scan(scan, std::move(plan), survey.bounds, survey.precision(), level_files(number, job), job);
  return {
      .number = number, .survey = std::move(survey), .tile_points = tile_points, .store = std::move(store)};
}

Level bucket_representatives(ThinnedScan thinned, std::size_t number, Job& job) {
  Level level = bucket_points(*read_representatives(thinned), number, job);
  thinned.representatives.reset();
  level.thinned.emplace(std::move(thinned));
  return level;
}

// Cells as large as the scan leave too few points to have neighbours. A scan of few points, or of one place,
// has no more at any resolution.
void refuse_too_coarse(const ThinnedScan& thinned, const Config& config) {
  const std::uint64_t left = thinned.left, finite = thinned.points - thinned.dropped;
  const auto k = static_cast<std::uint64_t>(config.neighbourhood.k);
  if (left > k || finite <= k || thinned.bounds.sizes().isZero(0)) return;
  const Eigen::Vector3d size = thinned.bounds.sizes();
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
  if (edge == 0) return bucket_points(input, 0, job);
  ThinnedScan thinned = thin_scan(input, edge, job);
  refuse_too_coarse(thinned, job.config);
  return bucket_representatives(std::move(thinned), 0, job);
}

std::optional<Level> thin_level(const Level& below, const Totals& totals, Job& job) {
  constexpr std::uint64_t kFewest = 200;  // points: fewer leave no interior around a hole
  const std::uint64_t points = below.store.tiling().points();
  // Edges are rounded powers.
  for (double edge = edge_above(totals.distances, below.edge() * 1.0001); edge > 0;
       edge = power_above(edge * 1.0001)) {
    ThinnedScan thinned = thin_store(below.store, edge, job);
    if (thinned.left < kFewest) break;
    if (thinned.left <= kMostLeft * static_cast<double>(points))
      return bucket_representatives(std::move(thinned), below.number + 1, job);
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
  level.extent = extent_of(level.survey.bounds);
  level.input = input.pass_counts();
  seal_level(level, job.made_from, job);
  return level;
}

std::optional<Level> level_above(const Level& below, const Totals& totals, Job& job) {
  if (std::optional<Level> kept = open_level(below.number + 1, below.evaluation, job)) return kept;
  std::optional<Level> level = thin_level(below, totals, job);
  if (!level) return std::nullopt;
  level->extent = below.extent;
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
