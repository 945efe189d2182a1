#include "engine/results/represented.hpp"

#include "engine/results/point_results.hpp"
#include "engine/store/outbox.hpp"

#include <filesystem>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

static_assert(kRepresentedBlock == kResultBlock);

// A result on disk, as plain data.
struct SpreadResult {
  PointId id;
  float probability;
  std::array<float, kMostCriteria> criteria;
  std::array<float, 3> normal;
  std::int32_t loop;
  std::uint8_t boundary, coherent;
};

SpreadResult stored(PointId id, const PointResult& r) {
  return {id,     r.probability, r.criteria, {r.normal.x(), r.normal.y(), r.normal.z()},
          r.loop, r.boundary,    r.coherent};
}

PointResult loaded(const SpreadResult& r) {
  return {r.probability, r.criteria, r.boundary, r.coherent, r.loop, {r.normal[0], r.normal[1], r.normal[2]}};
}

class SpreadDetection final : public Detection {
 public:
  SpreadDetection(std::unique_ptr<Detection> detection, AppendLists<Represented> represented, const Job& job)
      : detection_(std::move(detection)),
        represented_(std::move(represented)),
        file_(job.file("spread")),
        budget_(job.memory.spills / 4) {}

  const Summary& summary() const override { return detection_->summary(); }
  const std::vector<LoopMeasures>& loops() const override { return detection_->loops(); }
  void for_each_loop_point(std::size_t loop,
                           const std::function<void(const LoopPoint&)>& visit) const override {
    detection_->for_each_loop_point(loop, visit);
  }
  void for_each_boundary_point(const std::function<void(const BoundaryPoint&)>& visit) const override {
    detection_->for_each_boundary_point(visit);
  }
  std::uint64_t sampled_points() const override { return detection_->sampled_points(); }
  void for_each_sampled_point(const std::function<void(const SampledPoint&)>& visit) const override {
    detection_->for_each_sampled_point(visit);
  }
  ProbabilityLattice probability_lattice() const override { return detection_->probability_lattice(); }
  void for_each_probability_voxel(const std::function<void(const ProbabilityVoxel&)>& visit) const override {
    detection_->for_each_probability_voxel(visit);
  }

  void for_each_result_block(
      const std::function<void(PointId first, std::span<const PointResult>)>& visit) const override {
    AppendLists<SpreadResult> spread(file_, represented_.lists(), budget_);
    Outbox<SpreadResult> outbox(spread);
    detection_->for_each_result_block([&](PointId first, std::span<const PointResult> block) {
      represented_.for_each(value(first) / kResultBlock, [&](const Represented& r) {
        const PointResult& result = block[value(r.representative) - value(first)];
        outbox.add(static_cast<TileIndex>(value(r.id) / kResultBlock), stored(r.id, result));
      });
    });
    outbox.send();
    // Dropped points have no representative: the results are as they were.
    std::vector<PointResult> all;
    detection_->for_each_result_block([&](PointId first, std::span<const PointResult> block) {
      all.assign(block.begin(), block.end());
      spread.for_each(value(first) / kResultBlock,
                      [&](const SpreadResult& r) { all[value(r.id) - value(first)] = loaded(r); });
      visit(first, all);
    });
  }

 private:
  std::unique_ptr<Detection> detection_;
  AppendLists<Represented> represented_;
  std::filesystem::path file_;
  std::uint64_t budget_;
};

}  // namespace

std::unique_ptr<Detection> spread_results(std::unique_ptr<Detection> detection,
                                          AppendLists<Represented> represented, const Job& job) {
  return std::make_unique<SpreadDetection>(std::move(detection), std::move(represented), job);
}

}  // namespace lacuna
