// SPDX-License-Identifier: Apache-2.0
#include "engine/survey/survey_scan.hpp"

#include <optional>
#include <vector>

namespace lacuna {
namespace {

constexpr std::size_t kBatches = 4;  // in flight

// Counts the points of a pass that has begun.
void count_points(Survey& survey, PointSource& scan, std::uint64_t expected, const TaskArena& arena,
                  Phases& phases) {
  Phase phase(phases, "survey", expected);
  struct Counted {
    PointBatch batch;
    std::optional<CellCounts> counts;  // none while the cell size is not known
  };
  std::vector<Counted> batches(kBatches);
  arena.pipeline([&](std::size_t slot) { return scan.next(batches[slot].batch); },
                 [&](std::size_t slot) {
                   Counted& counted = batches[slot];
                   counted.counts.reset();
                   if (survey.is_sized()) counted.counts = count_cells(counted.batch, survey.finest());
                 },
                 [&](std::size_t slot) {
                   const Counted& counted = batches[slot];
                   counted.counts ? survey.add(*counted.counts) : survey.add(counted.batch);
                   phase.advance(counted.batch.size());
                 },
                 kBatches);
}

}  // namespace

SurveyedScan survey_scan(PointSource& scan, Job& job) {
  const std::uint64_t expected = scan.expected_points().value_or(0);
  const MemoryLedger::Lease reading = job.workers.memory.ledger.take(job.workers.memory.reading);
  Survey survey(job.workers.memory.cells, expected, job.spill.file("cells"));
  scan.rewind();
  count_points(survey, scan, expected, job.workers.arena, job.phases);
  if (!survey.is_sized()) scan.refuse_empty();
  return survey.finish();
}

SurveyedScan survey_parts(PointSource& scan, const IndexRange& parts, Job& job) {
  const MemoryLedger::Lease reading = job.workers.memory.ledger.take(job.workers.memory.reading);
  Survey survey(job.workers.memory.cells, scan.expected_points().value_or(0), job.spill.file("cells"));
  // All tasks count from one size on: the size for the first points of the scan.
  scan.rewind();
  for (PointBatch batch; !survey.is_sized() && scan.next(batch);) survey.choose_size(batch);
  if (!survey.is_sized()) scan.refuse_empty();
  scan.rewind_to(parts, PointId{0});
  count_points(survey, scan, 0, job.workers.arena, job.phases);
  return survey.counts();
}

SurveyedScan merge_surveys(std::size_t tasks, const std::function<SurveyedScan(std::size_t)>& survey_of_task,
                           std::optional<std::uint64_t> expected_points, const Spill& spill,
                           const Memory& memory) {
  Survey survey(memory.cells, expected_points.value_or(0), spill.file("cells"));
  for (std::size_t task = 0; task < tasks; ++task) survey.add(survey_of_task(task));
  return survey.finish();
}

}  // namespace lacuna
