// A finished run without the engine, for tests of what is written.
#pragma once

#include "engine/model/detection.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lacuna::test {

// A run that has found what the test says.
class FakeDetection final : public Detection {
 public:
  Summary numbers;
  std::vector<LoopMeasures> measures;
  std::vector<Loop> found;  // the points of each loop
  std::vector<BoundaryPoint> boundary;
  std::vector<PointResult> results;
  std::size_t block = 2;

  FakeDetection& with_loop(std::vector<std::uint64_t> ids, LoopKind kind) {
    Loop& loop = found.emplace_back();
    for (const std::uint64_t id : ids) {
      loop.push_back(
          {.id = PointId{id}, .position = {0.1 * static_cast<double>(id), 2, 3}, .probability = 0.25f});
    }
    measures.push_back(
        {.kind = kind, .points = ids.size(), .perimeter = 0.1, .centroid = {1, 2, 3}, .normal = {0, 0, 1}});
    return *this;
  }

  // As many results as the input has rows, each with its id as probability.
  FakeDetection& with_results(std::size_t count) {
    numbers.counts.points = count;
    for (std::size_t id = 0; id < count; ++id) {
      results.push_back({.probability = static_cast<float>(id),
                         .criteria = {0.25f, 0.5f, 0.75f},
                         .boundary = 1,
                         .coherent = 0,
                         .loop = -1,
                         .normal = {0, 0, 1}});
    }
    return *this;
  }

  const Summary& summary() const override { return numbers; }
  const std::vector<LoopMeasures>& loops() const override { return measures; }
  void for_each_loop_point(std::size_t loop,
                           const std::function<void(const LoopPoint&)>& visit) const override {
    for (const LoopPoint& point : found.at(loop)) visit(point);
  }
  void for_each_boundary_point(const std::function<void(const BoundaryPoint&)>& visit) const override {
    for (const BoundaryPoint& point : boundary) visit(point);
  }
  void for_each_result_block(
      const std::function<void(PointId, std::span<const PointResult>)>& visit) const override {
    for (std::size_t first = 0; first < results.size(); first += block) {
      visit(PointId{first}, std::span(results).subspan(first, std::min(block, results.size() - first)));
    }
  }

  std::uint64_t sampled_points() const override { return sample.size(); }
  void for_each_sampled_point(const std::function<void(const SampledPoint&)>& visit) const override {
    for (const SampledPoint& point : sample) visit(point);
  }
  ProbabilityLattice probability_lattice() const override { return lattice; }
  void for_each_probability_voxel(const std::function<void(const ProbabilityVoxel&)>& visit) const override {
    for (const ProbabilityVoxel& voxel : voxels) visit(voxel);
  }

  std::vector<SampledPoint> sample;
  ProbabilityLattice lattice;
  std::vector<ProbabilityVoxel> voxels;
};

}  // namespace lacuna::test
