#include "engine/pipeline.hpp"

#include "engine/boundary/paper/paper_boundary.hpp"
#include "engine/boundary/tangential/tangential_boundary.hpp"
#include "engine/evaluate/evaluate_tiles.hpp"
#include "engine/halo/eps_balls.hpp"
#include "engine/halo/halo.hpp"
#include "engine/loops/measure_loops.hpp"
#include "engine/results/collect.hpp"
#include "engine/results/orientation_graph.hpp"
#include "engine/results/probability_voxels.hpp"
#include "engine/results/represented.hpp"
#include "engine/results/scan_sample.hpp"
#include "engine/summarise.hpp"
#include "engine/thin/bucket_input.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

// The one place where the method is chosen.
std::unique_ptr<BoundaryMethod> boundary_method(const TileStore& store, const Job& job) {
  if (job.config.loops.method == LoopMethod::kPaper)
    return std::make_unique<paper::PaperBoundary>(store, job);
  return std::make_unique<tangential::TangentialBoundary>(store, job);
}

}  // namespace

std::unique_ptr<Detection> detect(PointSource& scan, const Config& given,
                                  const std::filesystem::path& workspace, Progress& progress) {
  check_config(given);
  const Config config = with_min_hole(given);
  Job job(config, workspace, progress);

  // Survey and bucket: where the points are, and the points in tiles on disk.
  Bucketed bucketed = bucket_input(scan, job);
  const TileStore& store = bucketed.store;
  const double extent = extent_of(bucketed.survey.bounds);
  const double eps = eps_length(config.neighbourhood, extent);
  Summary summary = summarise(bucketed, job);

  // Halo and evaluate: each point's criteria from its exact neighbourhood (paper, 4.1 to 4.6). Each consumer
  // keeps what it needs of an evaluated tile.
  refuse_balls(store.tiling(), eps, job);
  AppendLists<HaloEdge> halo = exchange_halo(store, job);
  Candidates candidates(store, job);
  const std::unique_ptr<BoundaryMethod> boundary = boundary_method(store, job);
  std::optional<PointResults> points;
  std::optional<ProbabilityVoxels> voxels;
  std::optional<ScanSample> sampler;
  std::optional<OrientationGraph> orientation;
  std::vector<TileConsumer*> consumers = {&candidates, boundary.get()};
  if (config.output.points) consumers.push_back(&points.emplace(summary.counts.points, store, job));
  if (config.output.vdb) consumers.push_back(&voxels.emplace(job));
  if (const std::int64_t most = config.output.sample_points; most > 0)
    consumers.push_back(&sampler.emplace(static_cast<std::uint64_t>(most), job));
  if (config.normals.orient) consumers.push_back(&orientation.emplace(store, job));
  const Totals totals = evaluate_tiles(store, std::move(halo), eps, extent, consumers, job);

  // Boundary edges, stitched across tiles to components, and their loops.
  const FoundLoops found = boundary->find_loops(totals, job);
  RowSet coherent = candidates.coherent(job);
  RowSet boundary_candidates = boundary->boundary_candidates(candidates, coherent, found.loops, job);
  MeasuredLoops loops =
      measure_loops(found.loops, boundary->loop_points(), store.tiling(), totals.mean_edge_length(), job);

  // Results, in the order of the input.
  std::optional<ProbabilityGrid> probabilities;
  if (voxels) probabilities.emplace(voxels->finish(store, bucketed.survey.middle, job));
  std::optional<Column<StoredSample>> sample;
  if (sampler) sample.emplace(sampler->finish(job));
  std::optional<RowSet> opposed_normals;
  if (orientation) opposed_normals = orientation->opposed_normals(job);
  add_findings(totals, found, eps, summary);
  std::unique_ptr<Detection> detection = collect_results(
      {std::move(summary), std::move(loops), std::move(coherent), std::move(boundary_candidates),
       std::move(points), std::move(probabilities), std::move(sample), std::move(opposed_normals)},
      candidates, store, job);
  if (!bucketed.thinned || !config.output.points) return detection;
  return spread_results(std::move(detection), std::move(*bucketed.thinned->represented), job);
}

}  // namespace lacuna
