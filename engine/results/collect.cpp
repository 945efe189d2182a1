// SPDX-License-Identifier: Apache-2.0
#include "engine/results/collect.hpp"

#include "engine/loops/nest_loops.hpp"
#include "engine/results/point_results.hpp"
#include "engine/store/append_lists.hpp"
#include "engine/store/column.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

// Calls visit(record) for each record of a column.
template <class Record, class Visit>
void for_each_record(const Column<Record>& column, Visit&& visit) {
  ColumnReader<Record> records(column);
  for (std::uint64_t i = 0; i < column.size(); ++i) visit(records[i]);
}

// The data from which result blocks are made.
struct ResultBlocks {
  std::uint64_t points;  // of the input
  PointResults results;
  std::shared_ptr<const Column<MarkedPoint>> boundary;  // in ascending id
  std::optional<RowSet> turned;                         // rows whose normal is turned round

  PointResult result(const ResultHead& r) const {
    PointResult result{.probability = r.probability, .criteria = {}, .normal = r.normal};
    if (turned && turned->contains(r.row))
      for (float& component : result.normal) component = -component;
    return result;
  }

  void for_each(const std::function<void(PointId first, std::span<const PointResult>)>& visit) const {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    PointResult dropped{.probability = kNaN, .criteria = {}, .normal = {kNaN, kNaN, kNaN}};
    dropped.criteria.fill(kNaN);
    ColumnReader<MarkedPoint> marks(*boundary);
    std::uint64_t next = 0;
    const std::uint64_t marked = boundary->size();
    std::vector<PointResult> block;
    for (std::size_t b = 0; b < results.blocks(); ++b) {
      const std::uint64_t first = b * kResultBlock, last = std::min(first + kResultBlock, points);
      block.assign(last - first, dropped);
      results.for_each(b, [&](const ResultHead& r, std::span<const float> criteria) {
        PointResult& point = block[value(r.id) - first] = result(r);
        std::copy(criteria.begin(), criteria.end(), point.criteria.begin());
      });
      for (; next < marked && value(marks[next].id) < last; ++next) {
        const MarkedPoint& p = marks[next];
        PointResult& point = block[value(p.id) - first];
        point.boundary = p.is_boundary();
        point.coherent = p.is_coherent();
        point.loop = p.reported_loop();
      }
      visit(PointId{first}, block);
    }
  }
};

// Each stream holds the data that it reads.
std::unique_ptr<Detection> make_detection(Findings findings, Column<MarkedPoint> boundary_points) {
  auto detection = std::make_unique<Detection>();
  detection->summary = std::move(findings.summary);
  NestedReport report = report_nested(findings.loops.measures, std::move(findings.selected));
  detection->loops = std::move(report.loops);
  detection->inner_rings = std::move(report.inner_rings);

  const auto loops = std::make_shared<const ChosenLoops>(std::move(findings.loops.loops));
  detection->for_each_loop_point = [loops, found = std::move(report.found)](std::size_t loop,
                                                                            const auto& visit) {
    loops->for_each_point(found[loop], visit);
  };

  const auto boundary = std::make_shared<const Column<MarkedPoint>>(std::move(boundary_points));
  detection->for_each_boundary_point = [boundary](const auto& visit) {
    for_each_record(*boundary, [&](const MarkedPoint& p) {
      if (p.is_boundary()) visit({p, p.probability, p.reported_loop()});
    });
  };
  if (findings.points) {
    const auto blocks =
        std::make_shared<const ResultBlocks>(ResultBlocks{.points = detection->summary.counts.points,
                                                          .results = *std::move(findings.points),
                                                          .boundary = boundary,
                                                          .turned = std::move(findings.opposed_normals)});
    detection->for_each_result_block = [blocks](const auto& visit) { blocks->for_each(visit); };
  }
  if (findings.sample) {
    const auto sample = std::make_shared<const Column<SampledPoint>>(*std::move(findings.sample));
    detection->sampled_points = sample->size();
    detection->for_each_sampled_point = [sample](const auto& visit) { for_each_record(*sample, visit); };
  }
  return detection;
}

// A tile's points that are coherent or belong to the boundary, each once.
std::vector<MarkedPoint> marks_of_tile(const TileOutputs& outputs, const Findings& findings, const Tile& tile,
                                       TileIndex t) {
  std::vector<MarkedPoint> marked = findings.on_loops.points.read(t);
  const std::vector<Candidate> candidates = outputs.read(kCandidates, t);
  const std::vector<CandidatePoint> points = outputs.read(kCandidatePoints, t);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Row row = candidates[i].row;
    const std::uint32_t marks = (findings.coherent.contains(row) ? MarkedPoint::kCoherent : 0) |
                                (findings.boundary_candidates.contains(row) ? MarkedPoint::kBoundary : 0);
    if (marks != 0)
      marked.push_back({points[i], tile.local(row), kNotReported, points[i].probability, marks});
  }
  std::sort(marked.begin(), marked.end(), [](const MarkedPoint& a, const MarkedPoint& b) {
    return std::tie(a.owned, a.loop, a.probability) < std::tie(b.owned, b.loop, b.probability);
  });
  std::size_t kept = 0;
  for (const MarkedPoint& p : marked) {
    if (kept > 0 && marked[kept - 1].owned == p.owned) {
      marked[kept - 1].marks |= p.marks;
    } else {
      marked[kept++] = p;
    }
  }
  marked.resize(kept);
  return marked;
}

static_assert(kRepresentedBlock == kResultBlock);

struct SpreadResult {
  PointId id;
  PointResult result;
};

}  // namespace

std::unique_ptr<Detection> collect_results(Findings findings, const TileOutputs& outputs,
                                           const TileStore& store, const Spill& spill, const Workers& workers,
                                           Phases& phases) {
  const Tiling& tiling = store.tiling();
  Summary& summary = findings.summary;
  Column<MarkedPoint> boundary_points(spill.file("boundary"));
  {
    Phase phase(phases, "collect", tiling.points());
    const MemoryLedger::Lease sorting = workers.memory.ledger.take(workers.memory.work / 3);
    SortedRuns<MarkedPoint> sorted(spill.file("boundary-sort"), sorting.bytes());
    std::mutex mutex;
    workers.arena.for_each(tiling.tiles.size(), [&](std::size_t i) {
      const auto t = static_cast<TileIndex>(i);
      const Tile& tile = tiling.tiles[t];
      const std::vector<MarkedPoint> marked = marks_of_tile(outputs, findings, tile, t);
      const std::lock_guard lock(mutex);
      for (const MarkedPoint& p : marked) {
        summary.counts.coherent += p.is_coherent();
        summary.counts.boundary_points += p.is_boundary();
        sorted.add(p);
      }
      store.for_each_duplicate(t, [&](const Duplicate& d) {
        const auto of =
            std::lower_bound(marked.begin(), marked.end(), d.of,
                             [](const MarkedPoint& p, LocalIndex owned) { return p.owned < owned; });
        if (of == marked.end() || of->owned != d.of) return;
        MarkedPoint duplicate = *of;
        duplicate.id = d.id;
        summary.counts.boundary_points += duplicate.is_boundary();
        sorted.add(duplicate);
      });
      phase.advance(tile.points);
    });
    ColumnWriter<MarkedPoint> writer(boundary_points);
    sorted.for_each([&](const MarkedPoint& p) { writer.add(p); });
    writer.finish();
  }
  summary.phases = phases.times;
  return make_detection(std::move(findings), std::move(boundary_points));
}

std::unique_ptr<Detection> spread_results(std::unique_ptr<Detection> detection,
                                          AppendLists<Represented> represented_points, const Spill& spill) {
  const auto represented = std::make_shared<const AppendLists<Represented>>(std::move(represented_points));
  detection->for_each_result_block = [represented, spill,
                                      of_representatives =
                                          std::move(detection->for_each_result_block)](const auto& visit) {
    AppendLists<SpreadResult> spread(spill, "spread", represented->lists());
    Outbox<SpreadResult> outbox(spread);
    of_representatives([&](PointId first, std::span<const PointResult> block) {
      represented->for_each(value(first) / kResultBlock, [&](const Represented& r) {
        const PointResult& result = block[value(r.representative) - value(first)];
        outbox.add(static_cast<TileIndex>(value(r.id) / kResultBlock), {r.id, result});
      });
    });
    outbox.send();
    // Dropped points have no representative: the results are as they were.
    std::vector<PointResult> all;
    of_representatives([&](PointId first, std::span<const PointResult> block) {
      all.assign(block.begin(), block.end());
      spread.for_each(value(first) / kResultBlock,
                      [&](const SpreadResult& r) { all[value(r.id) - value(first)] = r.result; });
      visit(first, all);
    });
  };
  return detection;
}

}  // namespace lacuna
