// SPDX-License-Identifier: Apache-2.0
#include "engine/estimate.hpp"

#include "engine/halo/eps_balls.hpp"
#include "engine/pipeline.hpp"
#include "engine/points_in_memory.hpp"
#include "engine/run/machine_memory.hpp"
#include "engine/store/temporary_folder.hpp"
#include "engine/summarise.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include <time.h>

namespace lacuna {
namespace {

constexpr std::uint64_t kSampleRuns = 4, kSamplePoints = 160'000;
constexpr double kBusyThreads = 0.85;  // of all threads, on a machine that does nothing else

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct SampledPoints {
  std::vector<Eigen::Vector3d> positions, normals;
};

// Runs of points in store order, evenly spread. The points of a run lie near each other, so that most have
// the neighbourhoods that they have in the scan.
SampledPoints sample_of(const TileStore& store) {
  SampledPoints sample;
  const Tiling& tiling = store.tiling();
  const std::uint64_t points = tiling.points();
  const std::uint64_t of_run = std::min(kSamplePoints, points) / kSampleRuns;
  std::uint64_t before = 0;
  for (std::size_t t = 0; t < tiling.tiles.size(); ++t) {
    const std::uint64_t end = before + tiling.tiles[t].points;
    std::vector<StoredPoint> stored;
    std::vector<Eigen::Vector3d> normals;
    for (std::uint64_t run = 0; run < kSampleRuns; ++run) {
      const std::uint64_t middle = (2 * run + 1) * points / (2 * kSampleRuns), begin = middle - of_run / 2;
      const std::uint64_t from = std::max(begin, before), to = std::min(begin + of_run, end);
      if (from >= to) continue;
      if (stored.empty()) {
        stored = store.points(static_cast<TileIndex>(t));
        normals = store.normals(static_cast<TileIndex>(t));
      }
      for (std::uint64_t i = from - before; i < to - before; ++i) {
        sample.positions.push_back(stored[i].position());
        if (!normals.empty()) sample.normals.push_back(normals[i]);
      }
    }
    before = end;
  }
  return sample;
}

double processor_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The options of the run, for a share of its points.
Config config_of_sample(Config config, double extent, double share) {
  config.scale = {.every_point = !has_levels(config)};
  config.neighbourhood.eps = eps_length(config.neighbourhood, extent);
  config.neighbourhood.eps_fraction = 0;
  config.run.workspace.clear();
  config.results.sample_points =
      static_cast<std::int64_t>(std::ceil(static_cast<double>(config.results.sample_points) * share));
  return config;
}

// Measures the steps behind bucketing, and how rough the surface is.
void add_sample(const TileStore& store, double extent, const Job& job, Estimate& estimate, RunSize& size) {
  const SampledPoints sample = sample_of(store);
  if (sample.positions.empty()) return;
  const double share =
      static_cast<double>(sample.positions.size()) / static_cast<double>(store.tiling().points());
  const TemporaryFolder workspace(job.workspace, "sample-");
  NoProgress silence;
  PointsInMemory scan(sample.positions, sample.normals);
  const Clock::time_point start = Clock::now();
  const double processor_start = processor_seconds();
  const auto detection = detect(scan, config_of_sample(job.config, extent, share), workspace.path(), silence);
  const double all = seconds_since(start), processor = processor_seconds() - processor_start;
  double seconds = all;
  for (const PhaseTime& phase : detection->summary.phases) {
    if (phase.name == "survey" || phase.name == "bucket") seconds -= phase.seconds;
  }
  estimate.seconds += seconds / share;
  size.candidates = static_cast<double>(detection->summary.counts.candidates) /
                    static_cast<double>(sample.positions.size());
  if (detection->summary.surface_area > 0) {
    estimate.density = static_cast<double>(sample.positions.size()) / detection->summary.surface_area;
  }
  estimate.slowdown =
      std::max(1.0, kBusyThreads * all * static_cast<double>(job.arena.threads()) / processor);
}

}  // namespace

Estimate estimate(PointSource& scan, const Config& given, const std::filesystem::path& workspace,
                  Progress& progress) {
  check_config(given);
  const Config config = with_min_hole(given);
  Job job(config, workspace, progress);
  const Clock::time_point start = Clock::now();
  const Level level = first_level(scan, job);

  const Tiling& tiling = level.store.tiling();
  Estimate estimate{.summary = summarise(level, job), .seconds = seconds_since(start)};
  estimate.summary.phases = job.phases;
  estimate.cell_size = level.survey.grid.edge();
  estimate.cells = tiling.cells.size();
  const Counts& counts = estimate.summary.counts;
  RunSize size{.rows = counts.points,
               .points = tiling.points(),
               .tile_points = level.tile_points(),
               .precision = level.survey.precision(),
               .is_thinned = level.edge > 0,
               .has_levels = has_levels(config),
               .has_normals = scan.has_normals(),
               .reads_slowly = scan.reads_slowly()};
  const std::uint64_t input_peak = peak_memory();
  add_sample(level.store, level.extent, job, estimate, size);
  estimate.disk = disk_needs(size, job);
  estimate.memory = std::max(input_peak, memory_needs(size, job));
  return estimate;
}

}  // namespace lacuna
