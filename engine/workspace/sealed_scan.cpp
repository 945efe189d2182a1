// SPDX-License-Identifier: Apache-2.0
#include "engine/workspace/sealed_scan.hpp"

#include "engine/store/sealed_part.hpp"

#include <algorithm>
#include <filesystem>
#include <span>
#include <utility>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kScattered = "points";

fs::path survey_path(const Workspace& workspace, std::size_t task) {
  return workspace.folder / ("survey-" + std::to_string(task));
}
fs::path plan_path(const Workspace& workspace) {
  return workspace.folder / "tiles";
}
fs::path scattered_path(const Workspace& workspace, std::size_t task) {
  return workspace.folder / ("bucket-" + std::to_string(task));
}

template <class Record>
void add(PartWriter& part, std::string_view stream, const std::vector<Record>& records) {
  part.add(stream, 0, std::span<const Record>(records));
}
template <class Record>
void add(PartWriter& part, std::string_view stream, const Record& record) {
  part.add(stream, 0, std::span<const Record>(&record, 1));
}

}  // namespace

void seal_survey(const SurveyedScan& survey, const std::vector<std::uint64_t>& pass_counts,
                 const TaskShare& share, const Workspace& workspace) {
  PartWriter part(survey_path(workspace, share.task));
  add<SurveyTotals>(part, "survey", survey);
  add(part, "cells", survey.cells);
  add(part, "input", pass_counts);
  part.seal(digest_of(workspace.made_from, share));
}

std::optional<SealedSurvey> open_survey(const TaskShare& share, const Workspace& workspace) {
  const std::optional<PartReader> part =
      PartReader::open(survey_path(workspace, share.task), digest_of(workspace.made_from, share));
  if (!part) return std::nullopt;
  return SealedSurvey{
      .survey = {part->records<SurveyTotals>("survey", 0).at(0), part->records<CountedCell>("cells", 0)},
      .pass_counts = part->records<std::uint64_t>("input", 0),
      .seal = line_of(part->checksum())};
}

std::optional<std::string> seals_of_surveys(std::size_t tasks, const Workspace& workspace) {
  std::string seals;
  for (std::size_t task = 0; task < tasks; ++task) {
    const std::optional<PartReader> part = PartReader::open(
        survey_path(workspace, task), digest_of(workspace.made_from, TaskShare{task, tasks}));
    if (!part) return std::nullopt;
    seals += line_of(part->checksum());
  }
  return seals;
}

void seal_plan(SealedPlan& sealed, const std::string& made_from, const Workspace& workspace) {
  PartWriter part(plan_path(workspace));
  const TilePlan& plan = sealed.plan;
  add<PlanTotals>(part, "plan", plan);
  add(part, "cells", plan.cells);
  add(part, "tiles", plan.tiles);
  add(part, "aside", plan.aside);
  add(part, "survey", sealed.survey);
  add(part, "input", sealed.pass_counts);
  add(part, "first ids", sealed.first_ids);
  sealed.seal = line_of(part.seal(digest_of(made_from)));
}

std::optional<SealedPlan> open_plan(const std::string& made_from, const Workspace& workspace) {
  const std::optional<PartReader> part = PartReader::open(plan_path(workspace), digest_of(made_from));
  if (!part) return std::nullopt;
  return SealedPlan{
      .plan = {part->records<PlanTotals>("plan", 0).at(0), part->records<CountedCell>("cells", 0),
               part->records<Tile>("tiles", 0), part->records<CountedCell>("aside", 0)},
      .survey = part->records<SurveyTotals>("survey", 0).at(0),
      .pass_counts = part->records<std::uint64_t>("input", 0),
      .first_ids = part->records<std::uint64_t>("first ids", 0),
      .seal = line_of(part->checksum())};
}

void seal_scattered(const ScatteredPoints& points, const TaskShare& share, const std::string& made_from,
                    const Workspace& workspace) {
  PartWriter part(scattered_path(workspace, share.task));
  for (std::size_t place = 0; place < points.places(); ++place) {
    points.for_each_packed(place,
                           [&](std::span<const std::byte> packed) { part.add(kScattered, place, packed); });
  }
  part.seal(digest_of(made_from, share));
}

std::optional<PartReader> open_scattered(const TaskShare& share, const std::string& made_from,
                                         const Workspace& workspace) {
  return PartReader::open(scattered_path(workspace, share.task), digest_of(made_from, share));
}

void visit_scattered(const PartReader& part, std::size_t place, const PointForm& form,
                     const VisitPoints& visit) {
  part.for_each<std::byte>(kScattered, place,
                           [&](std::span<const std::byte> packed) { visit(form.unpack(packed)); });
}

void remove_scan_parts(const Workspace& workspace) {
  for (const fs::path& file : workspace_files(workspace.folder)) {
    const std::string name = file.filename().string();
    if (name == "tiles" || name.starts_with("survey-") || name.starts_with("bucket-")) remove_part(file);
  }
}

}  // namespace lacuna
