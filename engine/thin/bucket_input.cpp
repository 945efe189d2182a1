#include "engine/thin/bucket_input.hpp"

#include "engine/bucket/bucket_scan.hpp"
#include "engine/bucket/split.hpp"
#include "engine/run/disk_space.hpp"
#include "engine/run/error.hpp"
#include "engine/store/kept_scan.hpp"
#include "engine/survey/survey_scan.hpp"
#include "engine/thin/choose_resolution.hpp"

#include <sstream>
#include <utility>

#include <spdlog/spdlog.h>

namespace lacuna {
namespace {

// Raw points of tiles are all written. Those that are set aside may be copies of a few.
std::uint64_t least_store_bytes(const TilePlan& plan, Precision precision) {
  std::uint64_t points = 0;
  for (const Tile& tile : plan.tiles) points += tile.raw;
  return points * (precision == Precision::kSingle ? sizeof(StoredPoint) / 2 : sizeof(StoredPoint));
}

Bucketed bucket_points(PointSource& scan, Job& job) {
  SurveyedScan survey = survey_scan(scan, job);
  const std::uint64_t points = survey.points - survey.dropped, tile_points = job.tile_points(points);
  TilePlan plan = split_tiles(std::move(survey.cells), survey.grid, points, tile_points);
  require_space(job.workspace, least_store_bytes(plan, survey.precision()));
  TileStore store = bucket_scan(scan, std::move(plan), survey.bounds, survey.precision(), job);
  return {{}, std::move(survey), tile_points, std::move(store)};
}

// Cells as large as the scan leave too few points to have neighbours. A scan of few points, or of one place,
// has no more at any resolution.
void refuse_too_coarse(const ThinnedScan& thinned, const Config& config) {
  const std::uint64_t left = thinned.representatives.size(), finite = thinned.points - thinned.dropped;
  const auto k = static_cast<std::uint64_t>(config.neighbourhood.k);
  if (left > k || finite <= k || thinned.bounds.sizes().isZero(0)) return;
  const Eigen::Vector3d size = thinned.bounds.sizes();
  const ScaleConfig& scale = config.scale;
  std::ostringstream message;
  message << "a resolution of " << scale.resolution;
  const bool is_of_hole = scale.min_hole > 0 && scale.resolution == scale.min_hole / kCellsAcross;
  if (is_of_hole) message << ", for holes of " << scale.min_hole << ",";
  message << " leaves " << left << " of " << finite << " points, too few for k = " << k
          << " neighbours; the scan's size is " << size.x() << " x " << size.y() << " x " << size.z()
          << "; allowed: a smaller " << (is_of_hole ? "--min-hole" : "--resolution");
  throw Error(message.str());
}

Bucketed bucket_representatives(PointSource& scan, double resolution, Job& job) {
  ThinnedScan thinned = thin_scan(scan, resolution, job);
  if (job.config.scale.resolution > 0) refuse_too_coarse(thinned, job.config);
  Bucketed bucketed = bucket_points(*read_representatives(thinned), job);
  bucketed.thinned.emplace(std::move(thinned));
  return bucketed;
}

}  // namespace

Bucketed bucket_input(PointSource& input, Job& job) {
  if (input.reads_slowly()) {
    KeptScan kept(input, job.file("input"));
    return bucket_input(kept, job);
  }
  const ScaleConfig& scale = job.config.scale;
  if (scale.resolution > 0) return bucket_representatives(input, scale.resolution, job);
  std::optional<Bucketed> all = bucket_points(input, job);
  const bool is_chosen = job.config.loops.method == LoopMethod::kTangential && !scale.every_point;
  const double resolution = is_chosen ? choose_resolution(all->store, job) : 0;
  if (resolution == 0) return *std::move(all);
  all.reset();  // before as much is stored again
  spdlog::info(
      "the points lie in lines, so one of them represents each cell of {}; --min-hole or --resolution "
      "set another size, --every-point uses all points",
      resolution);
  return bucket_representatives(input, resolution, job);
}

}  // namespace lacuna
