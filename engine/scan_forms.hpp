// SPDX-License-Identifier: Apache-2.0
// The results of the steps before the first level, and how they are parts.
#pragma once

#include "engine/bucket/set_aside.hpp"
#include "engine/bucket/split.hpp"
#include "engine/parts/parts.hpp"
#include "engine/store/sealed_part.hpp"
#include "engine/survey/survey.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lacuna {

// The counts of the points that a task reads.
struct TaskSurvey {
  SurveyedScan survey;
  std::vector<std::uint64_t> pass_counts;  // `PointSource::pass_counts`
  std::string seal;                        // the checksum of its part, a line; empty: it is not kept
};

// The tiles of the scan, from all counts.
struct ScanTiles {
  TilePlan plan;
  SurveyTotals survey;                     // of the whole scan
  std::vector<std::uint64_t> pass_counts;  // of the whole scan
  std::vector<std::uint64_t> first_ids;    // of each task's points
  std::string seal;
};

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

}  // namespace lacuna
