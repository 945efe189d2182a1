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
#include "engine/thin/bucket_input.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

double diagonal(const Eigen::AlignedBox3d& bounds) {
  return bounds.isEmpty() ? 0 : std::sqrt(squared_distance(bounds.max(), bounds.min()));
}

double eps_length(const NeighbourhoodConfig& config, double extent) {
  return config.eps > 0 ? config.eps : config.eps_fraction * extent;
}

// Counts and bounds are of the input, not of the representatives.
Summary summarise(const Bucketed& bucketed, const Job& job) {
  const auto& [thinned, survey, tile_points, store] = bucketed;
  Summary summary;
  summary.counts.points = survey.points;
  summary.counts.dropped = survey.dropped;
  summary.bounds = survey.bounds;
  if (thinned) {
    summary.resolution = thinned->resolution;
    summary.counts.points = thinned->points;
    summary.counts.dropped = thinned->dropped;
    summary.counts.thinned_out = thinned->points - thinned->dropped - thinned->representatives.size();
    summary.bounds = thinned->bounds;
  }
  summary.tiles = store.tiling().tiles.size();
  summary.tile_points = tile_points;
  summary.threads = job.arena.threads();
  summary.memory_limit = job.memory.limit;
  return summary;
}

// The one place where the method is chosen.
std::unique_ptr<BoundaryMethod> boundary_method(const TileStore& store, const Job& job) {
  if (job.config.loops.method == LoopMethod::kPaper)
    return std::make_unique<paper::PaperBoundary>(store, job);
  return std::make_unique<tangential::TangentialBoundary>(store, job);
}

// Of the workspace, for a clean scan.
std::uint64_t bytes_per_point(const PointSource& scan, const Config& config, Precision precision,
                              std::uint64_t tile_points) {
  const std::uint64_t stored = precision == Precision::kSingle ? 16 : sizeof(StoredPoint);
  const std::uint64_t normals = scan.has_normals() ? sizeof(StoredNormal) : 0;
  // Lists between tiles (halo edges, belts, open stars) hold points along borders: measured on clean
  // surfaces; noisy scans took up to three times the whole.
  const auto exchanged = static_cast<std::uint64_t>(16500 / std::sqrt(static_cast<double>(tile_points)));
  // Normals, the tiles' spanning forests, and all edges of these once more while they are sorted.
  const std::uint64_t orientation =
      config.normals.orient ? sizeof(StoredNormal) + 2 * sizeof(OrientationEdge) : 0;
  const std::uint64_t results = config.output.points ? sizeof(StoredResult) : 0;
  const std::uint64_t voxels = config.output.vdb ? sizeof(float) + sizeof(ProbabilityVoxel) + 20
                                                 : 0;  // at most one for each point, sorted
  const std::uint64_t kept = scan.reads_slowly() ? (scan.has_normals() ? 6 : 3) * sizeof(double) : 0;
  return stored + normals + std::max(kept, exchanged + orientation + results + voxels);
}

void add_findings(const Totals& totals, const FoundLoops& found, double eps, Summary& summary) {
  Counts& counts = summary.counts;
  counts.duplicates = counts.points - counts.dropped - counts.thinned_out - totals.points;
  counts.candidates = totals.candidates;
  counts.undefined_normals = totals.undefined_normals;
  counts.boundary_edges = found.edges;
  counts.components = found.components;
  counts.raw_loops = found.raw;
  summary.mean_neighbours = totals.mean_neighbours();
  summary.mean_edge_length = totals.mean_edge_length();
  summary.probabilities = totals.probabilities;
  summary.eps = eps;
  summary.e = found.minimum_loop;
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
  const double extent = diagonal(bucketed.survey.bounds);
  const double eps = eps_length(config.neighbourhood, extent);
  Summary summary = summarise(bucketed, job);

  // Halo and evaluate: every point judged from its exact neighbourhood (paper, 4.1 to 4.6). Each consumer
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

Estimate estimate(PointSource& scan, const Config& given, const std::filesystem::path& workspace,
                  Progress& progress) {
  check_config(given);
  const Config config = with_min_hole(given);
  Job job(config, workspace, progress);
  const Bucketed bucketed = bucket_input(scan, job);
  const Tiling& tiling = bucketed.store.tiling();
  Estimate estimate{.summary = summarise(bucketed, job)};
  estimate.summary.phases = job.phases;
  estimate.cell_size = bucketed.survey.grid.edge();
  estimate.cells = tiling.cells.size();
  const std::uint64_t points = bucketed.survey.points - bucketed.survey.dropped;
  estimate.workspace_bytes =
      points * bytes_per_point(scan, config, bucketed.survey.precision(), bucketed.tile_points);
  if (bucketed.thinned) {
    const std::uint64_t represented = config.output.points ? sizeof(Represented) + sizeof(PointResult) : 0;
    estimate.workspace_bytes += 2 * points * sizeof(Representative) + bucketed.thinned->points * represented;
  }
  return estimate;
}

std::uint64_t least_workspace_bytes(const PointSource& scan, const Config& config) {
  constexpr std::uint64_t kTilePoints = 1'000'000;
  const bool is_thinned = config.scale.resolution > 0 || config.scale.min_hole > 0;
  return is_thinned ? 0
                    : scan.expected_points().value_or(0) *
                          bytes_per_point(scan, config, Precision::kSingle, kTilePoints);
}

}  // namespace lacuna
