// SPDX-License-Identifier: Apache-2.0
#include "engine/scan_steps.hpp"

#include "engine/bucket/bucket_scan.hpp"
#include "engine/halo/halo.hpp"
#include "engine/parts/level_form.hpp"
#include "engine/run/error.hpp"
#include "engine/store/kept_scan.hpp"
#include "engine/store/sealed_part.hpp"
#include "engine/thin/thin.hpp"

#include <optional>
#include <sstream>
#include <utility>

namespace lacuna {
namespace {

// ---- The results of the steps, as parts

struct SurveyForm {
  static std::optional<TaskSurvey> read(const PartReader& part) {
    TaskSurvey task;
    static_cast<SurveyTotals&>(task.survey) = part.record<SurveyTotals>("survey");
    task.survey.cells = part.records<CountedCell>("cells");
    task.pass_counts = part.records<std::uint64_t>("input");
    task.seal = line_of(part.checksum());
    return task;
  }
  static void write(const TaskSurvey& task, PartWriter& part) {
    part.add_one<SurveyTotals>("survey", task.survey);
    part.add("cells", task.survey.cells);
    part.add("input", task.pass_counts);
  }
};

struct TilesForm {
  static std::optional<ScanTiles> read(const PartReader& part) {
    return ScanTiles{{part.record<PlanTotals>("plan"), part.records<CountedCell>("cells"),
                      part.records<Tile>("tiles"), part.records<CountedCell>("heavy")},
                     part.record<SurveyTotals>("survey"),
                     part.records<std::uint64_t>("input"),
                     part.records<std::uint64_t>("first ids"),
                     line_of(part.checksum())};
  }
  static void write(const ScanTiles& tiles, PartWriter& part) {
    part.add_one<PlanTotals>("plan", tiles.plan);
    part.add("cells", tiles.plan.cells);
    part.add("tiles", tiles.plan.tiles);
    part.add("heavy", tiles.plan.heavy);
    part.add_one("survey", tiles.survey);
    part.add("input", tiles.pass_counts);
    part.add("first ids", tiles.first_ids);
  }
};

struct BucketForm {
  PointLayout layout;

  std::optional<ScatteredPoints> read(PartReader part) const {
    return ScatteredPoints(std::move(part), layout);
  }
  static void write(const ScatteredPoints& points, PartWriter& part) { points.write(part); }
};

// ---- The steps

// The parts of the steps before the first level are kept where tasks share them.
Parts shared_parts(const StepContext& context) {
  return context.parts.plan.reads ? context.parts : Parts();
}

TaskShare share_of(const StepContext& context, std::size_t task) {
  return {task, context.parts.plan.tasks_of_level(0)};
}

IndexRange files_of(const StepContext& context, const TaskShare& share) {
  return share_of(context.parts.source.points, share);
}

PartKey key_of(const StepContext& context, std::string_view step, std::size_t task, std::string made_from) {
  return {std::string(step), share_of(context, task), std::move(made_from)};
}

PartKey level_key(const StepContext& context, std::size_t task) {
  return key_of(context, step_of_level(kLevel, 0), task, context.parts.made_from);
}

// Returns what the tiles are made from.
std::string seals_of_surveys(const StepContext& context) {
  std::string seals;
  if (!context.parts.plan.reads) return seals;
  for (std::size_t task = 0; task < context.parts.plan.tasks; ++task) {
    const std::optional<std::string> seal =
        context.parts.seal_of(key_of(context, kSurvey, task, context.parts.made_from));
    seals += seal ? *seal : survey_of_task(context, task).seal;
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
SurveyedScan survey_all(const StepContext& context, ScanTiles& tiles) {
  if (!context.parts.plan.reads) {
    SurveyedScan survey = survey_scan(context.scan, context.job);
    tiles.pass_counts = context.scan.pass_counts();
    return survey;
  }
  std::uint64_t first_id = 0;
  const auto survey_of = [&](std::size_t task) {
    TaskSurvey part = survey_of_task(context, task);
    tiles.first_ids.push_back(first_id);
    first_id += part.survey.ids;
    tiles.pass_counts.resize(part.pass_counts.size());
    for (std::size_t i = 0; i < part.pass_counts.size(); ++i) tiles.pass_counts[i] += part.pass_counts[i];
    return std::move(part.survey);
  };
  return merge_surveys(context.parts.plan.tasks, survey_of, context.scan.expected_points(), context.job.spill,
                       context.job.workers.memory);
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
Level store_all_points(const StepContext& context, const TaskShare& share, StoreFiles files) {
  std::optional<KeptScan> decoded;
  if (share.tasks == 1 && context.scan.reads_slowly())
    decoded.emplace(context.scan, context.job.spill.file("input"));
  const StepContext passes{decoded ? static_cast<PointSource&>(*decoded) : context.scan, context.parts,
                           context.job};
  ScanTiles tiles = tiles_of_scan(passes);
  std::vector<ScatteredPoints> scattered;
  for (std::size_t task = 0; task < share.tasks; ++task)
    scattered.push_back(points_of_task(passes, tiles, task));
  decoded.reset();
  const PointLayout layout{tiles.survey.precision(), context.scan.has_normals()};
  const auto for_each = [&](std::size_t place, const VisitPoints& visit) {
    for (const ScatteredPoints& points : scattered) points.for_each(place, visit);
  };
  return level_of(tiles, store_tiles(tiles.plan, share, tiles.survey.bounds, layout, for_each,
                                     std::move(files), context.job.workers, context.job.phases));
}

}  // namespace

std::string step_of_level(std::string_view name, std::size_t level) {
  return std::string(name) + "-" + std::to_string(level);
}

TaskSurvey survey_of_task(const StepContext& context, std::size_t task) {
  const PartKey key = key_of(context, kSurvey, task, context.parts.made_from);
  return shared_parts(context).get(key, SurveyForm(), [&] {
    SurveyedScan survey = survey_parts(context.scan, files_of(context, key.share), context.job);
    return TaskSurvey{std::move(survey), context.scan.pass_counts(), ""};
  });
}

ScanTiles tiles_of_scan(const StepContext& context) {
  const PartKey key{std::string(kTiles), {}, seals_of_surveys(context)};
  return shared_parts(context).get(key, TilesForm(), [&] {
    ScanTiles tiles;
    SurveyedScan survey = survey_all(context, tiles);
    refuse_tiny(survey.bounds);
    tiles.plan = plan_tiles(survey, context.job);
    tiles.survey = survey;
    return tiles;
  });
}

ScatteredPoints points_of_task(const StepContext& context, const ScanTiles& tiles, std::size_t task) {
  const PartKey key = key_of(context, kBucket, task, tiles.seal);
  const PointLayout layout{tiles.survey.precision(), context.scan.has_normals()};
  return shared_parts(context).get(key, BucketForm{layout}, [&] {
    const IndexRange files = files_of(context, key.share);
    context.parts.plan.reads ? context.scan.rewind_to(files, PointId{tiles.first_ids[task]})
                             : context.scan.rewind();
    return scatter_points(context.scan, tiles.plan, layout.precision, tiles.plan.points / key.share.tasks,
                          context.job);
  });
}

Level share_of_first_level(const StepContext& context, std::size_t task) {
  const PartKey key = level_key(context, task);
  const LevelForm form{context.parts, context.job, key.step};
  return context.parts.get(key, form, [&] {
    if (first_edge(context.job.config.scale) == 0) return store_all_points(context, key.share, form.files());
    const Level all = store_all_points(context, key.share, temporary_store(context.job.spill));
    return thin_to_first(all, form.files(), context.job);
  });
}

bool is_first_level_kept(const StepContext& context) {
  for (std::size_t task = 0; task < share_of(context, 0).tasks; ++task) {
    if (!context.parts.seal_of(level_key(context, task))) return false;
  }
  return true;
}

Level first_level(const StepContext& context) {
  std::vector<Level> shares;
  for (std::size_t task = 0; task < share_of(context, 0).tasks; ++task)
    shares.push_back(share_of_first_level(context, task));
  Level level = join_levels(std::move(shares), context.job.spill);
  if (context.parts.are_kept()) {
    context.scan.set_pass_counts(level.input);
    for (const std::string_view step : {kSurvey, kTiles, kBucket}) context.parts.drop(std::string(step));
  }
  if (context.job.config.normals.use == NormalsUse::kEstimated) level.store.leave_out_normals();
  return level;
}

}  // namespace lacuna
