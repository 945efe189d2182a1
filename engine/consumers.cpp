// SPDX-License-Identifier: Apache-2.0
#include "engine/consumers.hpp"

#include "engine/boundary/paper/paper_boundary.hpp"
#include "engine/boundary/tangential/tangential_boundary.hpp"

namespace lacuna {
namespace {

// The one place where the method is chosen.
std::unique_ptr<BoundaryMethod> boundary_method(const TileStore& store, const Job& job) {
  if (job.config.loops.method == LoopMethod::kPaper)
    return std::make_unique<paper::PaperBoundary>(store, job);
  return std::make_unique<tangential::TangentialBoundary>(store, job);
}

}  // namespace

Consumers::Consumers(const Level& level, const Job& job) : boundary(boundary_method(level.store, job)) {
  all.push_back(boundary.get());
  if (level.number > 0) return;
  const TileStore& store = level.store;
  const ResultsConfig& wanted = job.config.results;
  all.push_back(&candidates.emplace(store, job));
  if (wanted.points) all.push_back(&points.emplace(level.survey.points, store, job));
  if (wanted.voxels) all.push_back(&voxels.emplace(store, job));
  if (const std::int64_t most = wanted.sample_points; most > 0)
    all.push_back(&sample.emplace(static_cast<std::uint64_t>(most), level.survey.ids, store, job));
  if (job.config.normals.orient) all.push_back(&orientation.emplace(store, job));
}

}  // namespace lacuna
