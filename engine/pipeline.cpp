#include "engine/pipeline.hpp"

#include "engine/passes/bucket.hpp"
#include "engine/passes/coherence.hpp"
#include "engine/passes/evaluate.hpp"
#include "engine/passes/links.hpp"
#include "engine/passes/measure.hpp"
#include "engine/passes/orient.hpp"
#include "engine/passes/publish.hpp"
#include "engine/passes/rims.hpp"
#include "engine/passes/trace.hpp"
#include "engine/stages/split.hpp"

#include <cmath>
#include <numbers>

namespace lacuna {
namespace {

double diagonal(const Eigen::AlignedBox3d& bounds) {
  return bounds.isEmpty() ? 0 : std::sqrt(squared_distance(bounds.max(), bounds.min()));
}

double eps_length(const NeighbourhoodConfig& config, double extent) {
  return config.eps > 0 ? config.eps : config.eps_fraction * extent;
}

// Steps around the smallest hole that edges of neighbourhoods of K points do not cross.
std::int64_t minimum_loop(const SpanningConfig& config, double mean_neighbours) {
  return config.e > 0 ? config.e : std::llround(2 * std::sqrt(std::numbers::pi * mean_neighbours));
}

Summary summarise(const SurveyedScan& survey, const Tiling& tiling, std::uint64_t tile_points,
                  const Job& job) {
  Summary summary;
  summary.counts.points = survey.points;
  summary.counts.dropped = survey.dropped;
  summary.bounds = survey.bounds;
  summary.tiles = tiling.tiles.size();
  summary.tile_points = tile_points;
  summary.threads = job.crew.threads();
  summary.memory_limit = job.memory.limit;
  return summary;
}

struct Boundary {
  TracedLoops traced;
  RowSet coherent;
  std::int64_t e = 0;
};

// Along the rims of the surface that the points agree on (engine/README.md).
Boundary find_by_stars(EvaluatedScan& scan, const TileStore& store, Job& job) {
  RawLoops rims = trace_rims(scan.stars, store.tiling(), job);
  RowSet beside = find_beside_loops(rims, scan, store, job);
  return {{std::move(rims)}, std::move(beside)};
}

// Coherence, spanning graph and breadth first search (paper, 5.1 and 5.2).
Boundary find_by_paper(EvaluatedScan& scan, const TileStore& store, Job& job) {
  RowSet coherent = make_coherent(scan, store, job);
  const std::int64_t e = minimum_loop(job.config.spanning, scan.mean_neighbours());
  return {trace_loops(scan, store, e, job), std::move(coherent), e};
}

void add_findings(const EvaluatedScan& evaluated, const Boundary& boundary, double eps, Summary& summary) {
  Counts& counts = summary.counts;
  counts.duplicates = counts.points - counts.dropped - evaluated.totals.points;
  counts.candidates = evaluated.totals.candidates;
  counts.undefined_normals = evaluated.totals.undefined_normals;
  counts.eligible_edges = boundary.traced.eligible_edges;
  counts.components = boundary.traced.components;
  counts.raw_loops = boundary.traced.loops.found();
  summary.mean_neighbours = evaluated.mean_neighbours();
  summary.mean_edge_length = evaluated.mean_edge_length();
  summary.eps = eps;
  summary.e = boundary.e;
}

}  // namespace

std::unique_ptr<Detection> detect(PointSource& scan, const Config& config,
                                  const std::filesystem::path& workspace, Progress& progress) {
  check_config(config);
  Job job(config, workspace, progress);

  // Where the points are, and the points in tiles on disk.
  SurveyedScan survey = survey_scan(scan, job);
  const double extent = diagonal(survey.bounds);
  const double eps = eps_length(config.neighbourhood, extent);
  const std::uint64_t tile_points = job.tile_points(survey.points - survey.dropped);
  Tiling tiling = split_tiles(std::move(survey.cells), survey.grid, tile_points);
  Summary summary = summarise(survey, tiling, tile_points, job);
  const TileStore store = bucket_scan(scan, std::move(tiling), survey.precision(), job);

  // Every point judged from its neighbourhood (paper, 4.1 to 4.6).
  Spill<Link> links = link_tiles(store, job);
  EvaluatedScan evaluated = evaluate_tiles(store, std::move(links), survey.points, eps, extent, job);

  // Loops, and the boundary points beside them.
  const Boundary boundary = config.loops.method == LoopMethod::kTangential
                                ? find_by_stars(evaluated, store, job)
                                : find_by_paper(evaluated, store, job);
  const RawLoops& raw_loops = boundary.traced.loops;
  MeasuredLoops loops = measure_loops(raw_loops, evaluated, store, evaluated.mean_edge_length(), job);

  // Back into the order of the input.
  std::optional<RowSet> turned;
  if (config.normals.orient) turned = orient_normals(evaluated, store, job);
  add_findings(evaluated, boundary, eps, summary);
  return publish(std::move(evaluated), store, boundary.coherent, std::move(loops), std::move(turned),
                 std::move(summary), job);
}

Estimate estimate(PointSource& scan, const Config& config, Progress& progress) {
  check_config(config);
  Job job(config, {}, progress);
  SurveyedScan survey = survey_scan(scan, job);
  const std::uint64_t points = survey.points - survey.dropped;
  const std::uint64_t tile_points = job.tile_points(points);
  const Tiling tiling = split_tiles(std::move(survey.cells), survey.grid, tile_points);
  Estimate estimate{.summary = summarise(survey, tiling, tile_points, job)};
  estimate.summary.phases = job.phases;
  estimate.cell_size = tiling.grid.edge();
  estimate.cells = tiling.cells.size();
  const std::uint64_t normals = scan.has_normals() ? sizeof(StoredNormal) : 0;
  // Normals, the tiles' spanning forests, and all edges of these once more while they are sorted.
  const std::uint64_t orientation =
      config.normals.orient ? sizeof(StoredNormal) + 2 * sizeof(OrientationEdge) : 0;
  const std::uint64_t results = config.output.points ? sizeof(StoredResult) : 0;
  const std::uint64_t stored = survey.precision() == Precision::kSingle ? 16 : sizeof(StoredPoint);
  // What tiles tell each other, links, seats and waiting stars, is of points along their borders: measured on
  // clean surfaces; noisy scans took up to three times the whole.
  const auto told = static_cast<std::uint64_t>(16500 / std::sqrt(static_cast<double>(tile_points)));
  estimate.workspace_bytes = points * (stored + told + normals + orientation + results);
  return estimate;
}

}  // namespace lacuna
