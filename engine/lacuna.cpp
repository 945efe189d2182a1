// SPDX-License-Identifier: Apache-2.0
#include "engine/lacuna.hpp"

#include "engine/store/temporary_folder.hpp"

#include <memory>
#include <span>
#include <string>

namespace lacuna {

Holes find_holes(PointSource& scan, const Config& given, Progress* progress) {
  Config config = given;
  config.results.sample_points = 0;
  const TemporaryFolder scratch(temporary_parent(config.run.scratch), kScratchPrefix);
  NoProgress silence;
  const std::unique_ptr<Detection> detection =
      detect(scan, config, scratch.path(), progress == nullptr ? silence : *progress);

  Holes holes;
  holes.summary = detection->summary;
  holes.loops.reserve(detection->loops.size());
  for (std::size_t i = 0; i < detection->loops.size(); ++i) holes.loops.push_back(detection->read_loop(i));
  if (config.results.points) {
    holes.points.reserve(holes.summary.counts.points);
    detection->for_each_result_block([&](PointId, std::span<const PointResult> block) {
      holes.points.insert(holes.points.end(), block.begin(), block.end());
    });
  }
  return holes;
}

Holes find_holes(const PointArray& points, const PointArray& normals, const Config& config,
                 Progress* progress) {
  if (normals.size() != points.size()) {
    throw Error(std::to_string(normals.size()) + " normals for " + std::to_string(points.size()) +
                " points; allowed: one for each point");
  }
  PointsInMemory scan(points, normals);
  return find_holes(scan, config, progress);
}

Holes find_holes(const PointArray& points, const Config& config, Progress* progress) {
  PointsInMemory scan(points, {});
  return find_holes(scan, config, progress);
}

}  // namespace lacuna
