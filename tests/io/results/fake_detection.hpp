// SPDX-License-Identifier: Apache-2.0
// A finished run without the engine, for tests of what is written.
#pragma once

#include "io/explain/stations/cause.hpp"
#include "io/write/results/results.hpp"
#include "tests/support/tiled_scan.hpp"

namespace lacuna::test {

// A run that has found what the test says.
struct FakeDetection {
  Summary numbers;
  std::vector<LoopMeasures> measures;
  std::vector<Loop> found;  // the points of each loop
  std::vector<BoundaryPoint> boundary;
  std::vector<PointResult> results;
  std::size_t block = 2;

  FakeDetection& with_loop(std::vector<std::uint64_t> ids, LoopKind kind) {
    Loop& loop = found.emplace_back();
    for (const std::uint64_t id : ids)
      loop.push_back(loop_point(id, {0.1 * static_cast<double>(id), 2, 3}, {0, 0, 0}, 0.25f));
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

  // Its streams read this, which must outlive them.
  operator io::ExplainedDetection() const {
    const auto all_of = [](const auto& elements) {
      return [&elements](const auto& visit) {
        for (const auto& element : elements) visit(element);
      };
    };
    return {{.summary = numbers,
             .loops = measures,
             .for_each_loop_point =
                 [this](std::size_t loop, const auto& visit) {
                   for (const LoopPoint& point : found.at(loop)) visit(point);
                 },
             .inner_rings = rings(),
             .for_each_boundary_point = all_of(boundary),
             .for_each_result_block =
                 [this](const auto& visit) {
                   for (std::size_t first = 0; first < results.size(); first += block)
                     visit(PointId{first},
                           std::span(results).subspan(first, std::min(block, results.size() - first)));
                 },
             .sampled_points = sample.size(),
             .for_each_sampled_point = all_of(sample)},
            {.files = std::vector<io::FileCounts>(100)}};
  }

  std::vector<std::vector<InnerRing>> rings() const {
    std::vector<std::vector<InnerRing>> rings(measures.size());
    for (std::size_t i = 0; i < measures.size(); ++i) {
      if (measures[i].parent >= 0)
        rings[static_cast<std::size_t>(measures[i].parent)].push_back({i, measures[i].points});
    }
    return rings;
  }

  std::vector<SampledPoint> sample;
};

// The annotated scan is wanted.
inline io::FilesConfig with_points(io::PointsFormat format = io::PointsFormat::kInput,
                                   bool has_normals = false) {
  io::FilesConfig config;
  config.results.points = true;
  config.output.points_format = format;
  config.output.points_normals = has_normals;
  return config;
}

}  // namespace lacuna::test
