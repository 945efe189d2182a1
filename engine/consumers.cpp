// SPDX-License-Identifier: Apache-2.0
#include "engine/consumers.hpp"

#include "engine/boundary/candidates.hpp"
#include "engine/boundary/paper/paper_boundary.hpp"
#include "engine/boundary/tangential/tangential_boundary.hpp"
#include "engine/results/orientation.hpp"
#include "engine/results/point_results.hpp"

namespace lacuna {
namespace {

// The method that the config names.
std::unique_ptr<BoundaryMethod> boundary_method(const Tiling& tiling, const Job& job) {
  if (job.config.loops.method == LoopMethod::kPaper)
    return std::make_unique<paper::PaperBoundary>(tiling, job.config.spanning, job.spill, job.workers);
  return std::make_unique<tangential::TangentialBoundary>(tiling, job.config.tangential, job.spill,
                                                          job.workers);
}

}  // namespace

Consumers::Consumers(const Level& level, const Job& job)
    : method(boundary_method(level.store.tiling(), job)) {
  all.push_back([this](const EvaluatedTile& tile, TileOutput& output) { method->emit(tile, output); });
  if (level.number > 0) return;
  const ResultsConfig& wanted = job.config.results;
  all.push_back(emit_candidates);
  if (wanted.points) all.push_back(emit_point_results);
  if (wanted.sample_points > 0) {
    sample.emplace(static_cast<std::uint64_t>(wanted.sample_points));
    all.push_back([this](const EvaluatedTile& tile, TileOutput& output) { sample->emit(tile, output); });
  }
  if (job.config.normals.orient) all.push_back(emit_orientation);
}

}  // namespace lacuna
