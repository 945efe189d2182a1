#include "engine/results/collect.hpp"

#include "engine/store/column_writer.hpp"
#include "engine/store/sorted_runs.hpp"

#include <algorithm>
#include <limits>
#include <mutex>

namespace lacuna {
namespace {

// What a point is.
constexpr std::uint32_t kCoherent = 1, kBoundary = 2;

// A point of one tile that is coherent or belongs to the boundary.
struct Mark {
  LocalIndex owned;
  std::int32_t loop;  // the first reported loop through it; kNotReported: none
  float probability;
  std::uint32_t flags;
  StoredPoint point;
};

// A point of the input that is coherent or belongs to the boundary.
struct StoredBoundary {
  StoredPoint point;
  float probability;
  std::int32_t loop;  // -1: none
  std::uint64_t flags;

  bool is_boundary() const { return (flags & kBoundary) != 0; }

  friend bool operator<(const StoredBoundary& a, const StoredBoundary& b) { return a.point.id < b.point.id; }
};

using BoundarySort = SortedRuns<StoredBoundary>;

class WorkspaceDetection final : public Detection {
 public:
  WorkspaceDetection(Findings findings, Column<StoredBoundary> boundary)
      : summary_(std::move(findings.summary)),
        all_loops_(std::move(findings.loops)),
        selected_(std::move(findings.selected)),
        boundary_(std::move(boundary)),
        results_(std::move(findings.points)),
        probabilities_(std::move(findings.probabilities)),
        sample_(std::move(findings.sample)),
        turned_(std::move(findings.opposed_normals)) {
    for (const std::size_t loop : selected_) loops_.push_back(all_loops_.measures[loop]);
  }

  const Summary& summary() const override { return summary_; }
  const std::vector<LoopMeasures>& loops() const override { return loops_; }
  void for_each_loop_point(std::size_t loop,
                           const std::function<void(const LoopPoint&)>& visit) const override {
    all_loops_.loops.for_each_point(selected_[loop], [&](const StoredLoopPoint& p) { visit(loaded(p)); });
  }

  void for_each_boundary_point(const std::function<void(const BoundaryPoint&)>& visit) const override {
    ColumnReader<StoredBoundary> boundary(boundary_);
    for (std::uint64_t i = 0; i < boundary_.size(); ++i) {
      const StoredBoundary& p = boundary[i];
      if (p.is_boundary()) visit({p.point.id, p.point.position(), p.probability, p.loop});
    }
  }

  std::uint64_t sampled_points() const override { return sample_ ? sample_->size() : 0; }
  void for_each_sampled_point(const std::function<void(const SampledPoint&)>& visit) const override {
    if (!sample_) return;
    ColumnReader<StoredSample> sample(*sample_);
    for (std::uint64_t i = 0; i < sample_->size(); ++i) {
      const auto& [point, probability, normal] = sample[i];
      visit({point.id, point.position(), probability, {normal[0], normal[1], normal[2]}});
    }
  }

  ProbabilityLattice probability_lattice() const override { return probabilities_->lattice; }

  void for_each_probability_voxel(const std::function<void(const ProbabilityVoxel&)>& visit) const override {
    ColumnReader<ProbabilityVoxel> voxels(probabilities_->voxels);
    for (std::uint64_t i = 0; i < probabilities_->lattice.voxels; ++i) visit(voxels[i]);
  }

  void for_each_result_block(
      const std::function<void(PointId first, std::span<const PointResult>)>& visit) const override {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    PointResult dropped{.probability = kNaN, .normal = Eigen::Vector3f::Constant(kNaN)};
    dropped.criteria.fill(kNaN);
    ColumnReader<StoredBoundary> boundary(boundary_);
    std::uint64_t next_boundary = 0;
    const std::uint64_t marked = boundary_.size();
    std::vector<PointResult> block;
    for (std::size_t b = 0; b < results_->blocks(); ++b) {
      const std::uint64_t first = b * kResultBlock;
      const std::uint64_t last = std::min(first + kResultBlock, summary_.counts.points);
      block.assign(last - first, dropped);
      results_->for_each(b, [&](const StoredResult& r, std::span<const float> criteria) {
        PointResult& point = block[value(r.id) - first] = result(r);
        std::copy(criteria.begin(), criteria.end(), point.criteria.begin());
      });
      for (; next_boundary < marked && value(boundary[next_boundary].point.id) < last; ++next_boundary) {
        const StoredBoundary& p = boundary[next_boundary];
        PointResult& point = block[value(p.point.id) - first];
        point.boundary = p.is_boundary();
        point.coherent = (p.flags & kCoherent) != 0;
        point.loop = p.loop;
      }
      visit(PointId{first}, block);
    }
  }

 private:
  PointResult result(const StoredResult& r) const {
    const float sign = turned_ && turned_->contains(r.row) ? -1.0f : 1.0f;
    return {.probability = r.probability,
            .criteria = {},
            .normal = sign * Eigen::Vector3f(r.normal[0], r.normal[1], r.normal[2])};
  }

  Summary summary_;
  MeasuredLoops all_loops_;
  std::vector<std::size_t> selected_;
  std::vector<LoopMeasures> loops_;
  Column<StoredBoundary> boundary_;  // in ascending id
  std::optional<PointResults> results_;
  std::optional<ProbabilityGrid> probabilities_;
  std::optional<Column<StoredSample>> sample_;
  std::optional<RowSet> turned_;
};

// A tile's points that are coherent or belong to the boundary, each once.
std::vector<Mark> marks_of_tile(const Candidates& candidates, const Findings& findings, const Tile& tile,
                                TileIndex t) {
  std::vector<Mark> marks;
  for (const PointOnLoop& p : findings.on_loops.points.read(t))
    marks.push_back({p.owned, p.loop, p.probability, kBoundary, p.point});
  for (const StoredCandidate& c : candidates.read(t)) {
    const Row row = c.candidate.row;
    const std::uint32_t flags = (findings.coherent.contains(row) ? kCoherent : 0) |
                                (findings.boundary_candidates.contains(row) ? kBoundary : 0);
    if (flags != 0) marks.push_back({tile.local(row), kNotReported, c.probability, flags, c.point});
  }
  std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) {
    return a.owned != b.owned ? a.owned < b.owned : a.loop < b.loop;
  });
  std::size_t kept = 0;
  for (const Mark& mark : marks) {
    if (kept > 0 && marks[kept - 1].owned == mark.owned) {
      marks[kept - 1].flags |= mark.flags;
    } else {
      marks[kept++] = mark;
    }
  }
  marks.resize(kept);
  return marks;
}

StoredBoundary stored(const Mark& mark) {
  return {mark.point, mark.probability, mark.loop == kNotReported ? -1 : mark.loop, mark.flags};
}

}  // namespace

std::unique_ptr<Detection> collect_results(Findings findings, const Candidates& candidates,
                                           const TileStore& store, Job& job) {
  const Tiling& tiling = store.tiling();
  Summary& summary = findings.summary;
  Column<StoredBoundary> boundary_points(job.file("boundary"));
  {
    Phase phase(job, "collect", tiling.points());
    BoundarySort sorted(job.file("boundary-sort"), job.memory.global / 3);
    std::mutex mutex;
    job.arena.for_each(tiling.tiles.size(), [&](std::size_t t) {
      const Tile& tile = tiling.tiles[t];
      const std::vector<Mark> tile_marks =
          marks_of_tile(candidates, findings, tile, static_cast<TileIndex>(t));
      const std::lock_guard lock(mutex);
      for (const Mark& mark : tile_marks) {
        summary.counts.coherent += (mark.flags & kCoherent) != 0;
        summary.counts.boundary_points += (mark.flags & kBoundary) != 0;
        sorted.add(stored(mark));
      }
      store.for_each_duplicate(static_cast<TileIndex>(t), [&](const Duplicate& d) {
        const auto of = std::lower_bound(tile_marks.begin(), tile_marks.end(), d.of,
                                         [](const Mark& m, LocalIndex p) { return m.owned < p; });
        if (of == tile_marks.end() || of->owned != d.of) return;
        StoredBoundary duplicate = stored(*of);
        duplicate.point.id = d.id;
        summary.counts.boundary_points += duplicate.is_boundary();
        sorted.add(duplicate);
      });
      phase.advance(tile.points);
    });
    ColumnWriter<StoredBoundary> writer(boundary_points);
    sorted.for_each([&](const StoredBoundary& p) { writer.add(p); });
    writer.finish();
  }
  summary.phases = job.phases;
  return std::make_unique<WorkspaceDetection>(std::move(findings), std::move(boundary_points));
}

}  // namespace lacuna
