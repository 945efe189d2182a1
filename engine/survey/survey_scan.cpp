// SPDX-License-Identifier: Apache-2.0
#include "engine/survey/survey_scan.hpp"

#include <optional>
#include <vector>

namespace lacuna {
namespace {

constexpr std::size_t kBatches = 4;  // in flight

void count_points(Survey& survey, PointSource& scan, std::uint64_t expected, Job& job) {
  Phase phase(job, "survey", expected);
  struct Counted {
    PointBatch batch;
    std::optional<CellCounts> counts;  // none while the cell size is not known
  };
  std::vector<Counted> batches(kBatches);
  scan.rewind();
  job.arena.pipeline([&](std::size_t slot) { return scan.next(batches[slot].batch); },
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
  const MemoryLedger::Lease reading = job.ledger.take(job.memory.reading);
  Survey survey(job.memory.cells, expected);
  count_points(survey, scan, expected, job);
  return survey.finish();
}

}  // namespace lacuna
