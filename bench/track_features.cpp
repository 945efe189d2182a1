// SPDX-License-Identifier: Apache-2.0
// Writes the values from which the confidence of every loop is computed, at every level of one scan, with
// default parameters. It writes two files for bench/accuracy/calibrate.py. One has the loops as `lacuna-bench
// evaluate` reads them. The other has their numbers, in the same order.
#include "engine/boundary/tangential/tangential_boundary.hpp"
#include "engine/config/config.hpp"
#include "engine/pipeline_steps.hpp"
#include "engine/run/job.hpp"
#include "engine/run/progress.hpp"
#include "engine/store/temporary_folder.hpp"
#include "engine/track/level_loops.hpp"
#include "engine/track/near_loops.hpp"
#include "engine/track/track_all.hpp"
#include "io/options/options.hpp"
#include "io/scan/file_scan.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lacuna {
namespace {

namespace fs = std::filesystem;

// Returns the levels as engine/pipeline.cpp finds them, from fine to coarse.
std::vector<LevelLoops> find_all_loops(PointSource& scan, Job& job) {
  std::optional<Level> level = first_level(scan, {}, job);
  std::vector<LevelLoops> levels;
  while (level) {
    tangential::TangentialBoundary boundary(level->store.tiling(), job);
    const std::vector<TileConsumer> consumers = {
        [&](const EvaluatedTile& tile, TileOutput& output) { boundary.emit(tile, output); }};
    const TileOutputs outputs = evaluate_level(*level, consumers, {}, job);
    const Totals totals = read_totals(outputs, level->store.tiling(), level->extent);
    boundary.complete_edges(outputs);
    boundary.stitch(outputs, totals);
    levels.push_back(level_loops(boundary.find_loops(outputs).loops, level->edge, totals));
    std::optional<Level> above = level_above(*level, totals, {}, job);
    level.reset();
    if (above) level.emplace(*std::move(above));
  }
  return levels;
}

std::ofstream open(const fs::path& file) {
  std::ofstream out(file);
  out.exceptions(std::ios::failbit | std::ios::badbit);
  out.precision(std::numeric_limits<double>::max_digits10);
  return out;
}

void write_loops(const fs::path& file, std::span<const LevelLoops> levels) {
  std::ofstream out = open(file);
  out << "# one loop per line, level by level, 0-based point ids\n";
  for (const LevelLoops& level : levels) {
    for (std::size_t i = 0; i < level.loops.size(); ++i) {
      level.loops.for_each_point(i, [&](const StoredLoopPoint& p) { out << value(p.point.id) << ' '; });
      out << '\n';
    }
  }
  out.close();
}

void write_features(const fs::path& file, std::span<const LevelLoops> levels,
                    std::span<const TrackedLoop> loops) {
  std::ofstream out = open(file);
  out << "level,edge,is_coarse,clearness,surface,sampling_gap,best,persistence,roundness,log_odds\n";
  for (const TrackedLoop& loop : loops) {
    const LevelLoops& level = levels[loop.level];
    const TrackEvidence& e = loop.evidence;
    out << loop.level << ',' << level.edge << ',' << level.loops.evidence(loop.loop).is_coarse << ','
        << e.clearness << ',' << e.surface << ',' << e.sampling_gap << ',' << e.best << ',' << e.persistence
        << ',' << e.roundness << ',' << loop.log_odds << '\n';
  }
  out.close();
}

void run(const fs::path& scan_file, const fs::path& loops_file, const fs::path& features_file) {
  io::FilesConfig config;
  config.run.threads = 1;
  const TemporaryFolder workspace(fs::temp_directory_path(), "lacuna-track-features-");
  NoProgress quiet;
  Job job(config, workspace.path(), quiet);
  io::FileScan scan({scan_file}, config.input);
  const std::vector<LevelLoops> levels = find_all_loops(scan, job);
  write_loops(loops_file, levels);
  write_features(features_file, levels, track_all(levels, near_loops(levels, job), job));
}

}  // namespace
}  // namespace lacuna

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s SCAN OUT.loops.txt OUT.csv\n", argv[0]);
    return 2;
  }
  try {
    lacuna::run(argv[1], argv[2], argv[3]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}
