// SPDX-License-Identifier: Apache-2.0
#include "engine/scan_steps.hpp"

#include "engine/bucket/bucket_scan.hpp"
#include "engine/halo/halo.hpp"
#include "engine/parts/level_form.hpp"
#include "engine/run/error.hpp"
#include "engine/scan_forms.hpp"
#include "engine/store/kept_scan.hpp"
#include "engine/survey/survey.hpp"
#include "engine/thin/thin.hpp"

#include <optional>
#include <sstream>
#include <utility>

namespace lacuna {
namespace {

// The parts of the steps before the first level are kept where tasks share them.
Parts shared_parts(const StepContext& given) {
  return given.parts.plan.reads ? given.parts : Parts();
}

TaskShare share_of(const StepContext& given, std::size_t task) {
  return {task, given.parts.plan.tasks_of_level(0)};
}

IndexRange files_of(const StepContext& given, const TaskShare& share) {
  return share_of(given.parts.source.points, share);
}

PartKey key_of(const StepContext& given, std::string_view step, std::size_t task, std::string made_from) {
  return {std::string(step), share_of(given, task), std::move(made_from)};
}

PartKey level_key(const StepContext& given, std::size_t task) {
  return key_of(given, step_of_level(kLevel, 0), task, given.parts.made_from);
}

// Returns what the tiles are made from.
std::string seals_of_surveys(const StepContext& given) {
  std::string seals;
  if (!given.parts.plan.reads) return seals;
  for (std::size_t task = 0; task < given.parts.plan.tasks; ++task) {
    const std::optional<std::string> seal =
        given.parts.seal_of(key_of(given, kSurvey, task, given.parts.made_from));
    seals += seal ? *seal : survey_of_task(given, task).seal;
  }
  return seals;
}

void refuse_tiny(const Eigen::AlignedBox3d& bounds) {
  const double extent = bounds.isEmpty() ? 0 : bounds.sizes().maxCoeff();
  if (extent == 0 || extent >= kLeastExtent) return;
  std::ostringstream message;
  message << "all points lie within " << extent << "; allowed: an extent of " << kLeastExtent
          << " or more; another unit makes coordinates larger";
  throw Error(message.str());
}

// Surveys the whole scan, alone or from the surveys of all tasks.
SurveyedScan survey_all(const StepContext& given, ScanTiles& tiles) {
  if (!given.parts.plan.reads) {
    SurveyedScan survey = survey_scan(given.scan, given.job);
    tiles.pass_counts = given.scan.pass_counts();
    return survey;
  }
  std::uint64_t first_id = 0;
  const auto survey_of = [&](std::size_t task) {
    TaskSurvey part = survey_of_task(given, task);
    tiles.first_ids.push_back(first_id);
    first_id += part.survey.ids;
    tiles.pass_counts.resize(part.pass_counts.size());
    for (std::size_t i = 0; i < part.pass_counts.size(); ++i) tiles.pass_counts[i] += part.pass_counts[i];
    return std::move(part.survey);
  };
  return merge_surveys(given.parts.plan.tasks, survey_of, given.scan.expected_points(), given.job.spill,
                       given.job.workers.memory);
}

Level level_of(const ScanTiles& tiles, TileStore store) {
  const double extent = extent_of(tiles.survey.bounds);
  return {.survey = tiles.survey,
          .extent = extent,
          .tile_points = tiles.plan.tile_points,
          .store = std::move(store),
          .input = tiles.pass_counts,
          .represented = {}};
}

// Brings all points of a task's tiles into a store on disk.
Level store_all_points(const StepContext& given, const TaskShare& share, StoreFiles files) {
  std::optional<KeptScan> decoded;
  if (share.tasks == 1 && given.scan.reads_slowly())
    decoded.emplace(given.scan, given.job.spill.file("input"));
  const StepContext passes{decoded ? static_cast<PointSource&>(*decoded) : given.scan, given.parts,
                           given.job};
  ScanTiles tiles = tiles_of_scan(passes);
  std::vector<ScatteredPoints> scattered;
  for (std::size_t task = 0; task < share.tasks; ++task)
    scattered.push_back(points_of_task(passes, tiles, task));
  decoded.reset();
  const PointLayout layout{tiles.survey.precision(), given.scan.has_normals()};
  const auto for_each = [&](std::size_t place, const VisitPoints& visit) {
    for (const ScatteredPoints& points : scattered) points.for_each(place, visit);
  };
  return level_of(tiles, store_tiles(tiles.plan, share, tiles.survey.bounds, layout, for_each,
                                     std::move(files), given.job.workers, given.job.phases));
}

}  // namespace

std::string step_of_level(std::string_view name, std::size_t level) {
  return std::string(name) + "-" + std::to_string(level);
}

TaskSurvey survey_of_task(const StepContext& given, std::size_t task) {
  const PartKey key = key_of(given, kSurvey, task, given.parts.made_from);
  return shared_parts(given).get(key, SurveyForm(), [&] {
    SurveyedScan survey = survey_parts(given.scan, files_of(given, key.share), given.job);
    return TaskSurvey{std::move(survey), given.scan.pass_counts(), ""};
  });
}

ScanTiles tiles_of_scan(const StepContext& given) {
  const PartKey key{std::string(kTiles), {}, seals_of_surveys(given)};
  return shared_parts(given).get(key, TilesForm(), [&] {
    ScanTiles tiles;
    SurveyedScan survey = survey_all(given, tiles);
    refuse_tiny(survey.bounds);
    tiles.plan = plan_tiles(survey, given.job);
    tiles.survey = survey;
    return tiles;
  });
}

ScatteredPoints points_of_task(const StepContext& given, const ScanTiles& tiles, std::size_t task) {
  const PartKey key = key_of(given, kBucket, task, tiles.seal);
  const PointLayout layout{tiles.survey.precision(), given.scan.has_normals()};
  return shared_parts(given).get(key, BucketForm{layout}, [&] {
    const IndexRange files = files_of(given, key.share);
    given.parts.plan.reads ? given.scan.rewind_to(files, PointId{tiles.first_ids[task]})
                           : given.scan.rewind();
    return scatter_points(given.scan, tiles.plan, layout.precision, tiles.plan.points / key.share.tasks,
                          given.job);
  });
}

Level share_of_first_level(const StepContext& given, std::size_t task) {
  const PartKey key = level_key(given, task);
  const LevelForm form{given.parts, given.job, key.step};
  return given.parts.get(key, form, [&] {
    if (first_edge(given.job.config.scale) == 0) return store_all_points(given, key.share, form.files());
    const Level all = store_all_points(given, key.share, temporary_store(given.job.spill));
    return thin_to_first(all, form.files(), given.job);
  });
}

bool is_first_level_kept(const StepContext& given) {
  for (std::size_t task = 0; task < share_of(given, 0).tasks; ++task) {
    if (!given.parts.seal_of(level_key(given, task))) return false;
  }
  return true;
}

Level first_level(const StepContext& given) {
  std::vector<Level> shares;
  for (std::size_t task = 0; task < share_of(given, 0).tasks; ++task)
    shares.push_back(share_of_first_level(given, task));
  Level level = join_levels(std::move(shares), given.job.spill);
  if (given.parts.are_kept()) {
    given.scan.set_pass_counts(level.input);
    for (const std::string_view step : {kSurvey, kTiles, kBucket}) given.parts.drop(std::string(step));
  }
  if (given.job.config.normals.use == NormalsUse::kEstimated) level.store.leave_out_normals();
  return level;
}

}  // namespace lacuna
