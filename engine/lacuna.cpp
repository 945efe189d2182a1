#include "engine/lacuna.hpp"

#include "engine/points_in_memory.hpp"
#include "engine/store/temporary_folder.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace lacuna {
namespace {

using Vectors = std::span<const Eigen::Vector3d>;

}  // namespace

Holes find_holes(PointSource& scan, const Config& config) {
  namespace fs = std::filesystem;
  const fs::path parent =
      config.run.scratch.empty() ? fs::temp_directory_path() : fs::path(config.run.scratch);
  const TemporaryFolder scratch(parent, "lacuna-");
  NoProgress silence;
  const std::unique_ptr<Detection> detection = detect(scan, config, scratch.path(), silence);

  Holes holes;
  holes.summary = detection->summary;
  holes.loops.reserve(detection->loops.size());
  for (std::size_t i = 0; i < detection->loops.size(); ++i) holes.loops.push_back(detection->read_loop(i));
  if (config.output.points) {
    holes.points.reserve(holes.summary.counts.points);
    detection->for_each_result_block([&](PointId, std::span<const PointResult> block) {
      holes.points.insert(holes.points.end(), block.begin(), block.end());
    });
  }
  return holes;
}

Holes find_holes(Vectors points, Vectors normals, const Config& config) {
  if (normals.size() != points.size()) {
    throw Error(std::to_string(normals.size()) + " normals for " + std::to_string(points.size()) +
                " points; allowed: one for each point");
  }
  PointsInMemory scan(points, normals);
  return find_holes(scan, config);
}

Holes find_holes(Vectors points, const Config& config) {
  PointsInMemory scan(points, {});
  return find_holes(scan, config);
}

}  // namespace lacuna
