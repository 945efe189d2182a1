#include "tools/info_command.hpp"

#include "engine/config.hpp"
#include "engine/pipeline.hpp"
#include "io/file_scan.hpp"
#include "io/results/json.hpp"
#include "io/results/points.hpp"
#include "io/results/results.hpp"
#include "engine/store/temporary_folder.hpp"
#include "tools/input_files.hpp"
#include "tools/parameter_options.hpp"
#include "tools/scan_warnings.hpp"
#include "tools/summary.hpp"
#include "tools/terminal.hpp"
#include "tools/visible_text.hpp"
#include "tools/workspace.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;

// Measured: points per second of a whole `lacuna detect` with default parameters, on two threads.
constexpr double kPointsPerSecond = 1'900'000;
constexpr double kMeasuredThreads = 2;
// Measured: points per second that are read to choose the resolution, and read and thinned out.
constexpr double kThinnedPerSecond = 4'000'000;

struct InfoArguments {
  explicit InfoArguments(CLI::App& command) : parameters(command) {}

  std::vector<fs::path> scans;
  bool json = false;
  ParameterOptions parameters;
};

struct FileInfo {
  fs::path file;
  std::string format;
  std::string crs;
  RowLayout layout;
  std::uint64_t points = 0;
};

struct RunInfo {
  Estimate estimate;
  std::string points_file;
  std::uint64_t points_bytes = 0;
  double seconds = 0;
};

std::uint64_t count_rows(ScanReader& reader) {
  if (const auto expected = reader.expected_rows()) return *expected;
  constexpr std::size_t kRowsAtATime = 1 << 16;
  std::uint64_t rows = 0;
  for (RowBatch batch; reader.next(batch, kRowsAtATime);) rows += batch.count;
  return rows;
}

FileInfo read_file_info(const fs::path& file, const ReadOptions& options) {
  const std::unique_ptr<ScanReader> reader = open_scan(file, options);
  return {file, reader->format(), reader->crs(), reader->layout(), count_rows(*reader)};
}

RunInfo estimate_run(FileScan& scan, const Config& config) {
  RunInfo run;
  NoProgress silence;
  const MadeFolder parent(config.run.workspace.empty() ? fs::temp_directory_path()
                                                       : fs::path(config.run.workspace));
  const TemporaryFolder workspace(parent.path(), "lacuna-");
  run.estimate = estimate(scan, config, workspace.path(), silence);
  const Summary& summary = run.estimate.summary;
  run.points_file = points_file(scan, config.output);
  run.points_bytes = point_row_bytes(scan, config.output) * summary.counts.points;

  const double threads = std::max<double>(1, static_cast<double>(summary.threads));
  const std::uint64_t points = summary.counts.points - summary.counts.thinned_out;
  run.seconds = static_cast<double>(points) / kPointsPerSecond * kMeasuredThreads / threads +
                static_cast<double>(summary.counts.thinned_out) / kThinnedPerSecond;
  return run;
}

std::string print_point(const Eigen::Vector3d& point) {
  std::ostringstream out;
  out.precision(10);
  out << point.x() << " " << point.y() << " " << point.z();
  return out.str();
}

std::string assumption() {
  return "assuming " + print_count(static_cast<std::uint64_t>(kPointsPerSecond)) + " points/s on " +
         std::to_string(static_cast<int>(kMeasuredThreads)) + " threads, and twice that on twice as many";
}

void print_text(const std::vector<FileInfo>& files, const FilteredOut& filtered, const RunInfo& run) {
  for (const FileInfo& file : files) {
    std::cout << visible(file.file.string()) << "\n  format      " << file.format << "\n  points      "
              << print_count(file.points);
    if (!file.crs.empty()) std::cout << "\n  crs         " << crs_name(file.crs);
    std::cout << "\n  properties ";
    for (const Property& property : file.layout.properties) {
      std::cout << " " << property.name << " (" << ply_name(property.type) << ")";
    }
    std::cout << "\n";
  }
  const Summary& summary = run.estimate.summary;
  std::cout << "\na run of lacuna detect\n  points        " << print_count(summary.counts.points);
  std::cout << print_left_out(summary.counts, filtered);
  if (summary.resolution > 0) {
    std::cout << "\n  resolution    " << summary.resolution << ": "
              << print_count(summary.counts.points - summary.counts.dropped - summary.counts.thinned_out)
              << " points represent the others";
  }
  std::cout << "\n  bounds        ";
  if (summary.bounds.isEmpty()) {
    std::cout << "none: no finite point";
  } else {
    std::cout << print_point(summary.bounds.min()) << " to " << print_point(summary.bounds.max());
  }
  std::cout << "\n  tiles         " << print_count(summary.tiles) << ", of at most "
            << print_count(summary.tile_points) << " points"
            << "\n  cells         " << print_count(run.estimate.cells) << ", of size "
            << run.estimate.cell_size << "\n  memory limit  " << print_size(summary.memory_limit)
            << "\n  threads       " << summary.threads << "\n  workspace     "
            << print_size(run.estimate.workspace_bytes)
            << " on disk; up to three times that if the scan is noisy"
            << "\n  " << run.points_file << "    " << print_size(run.points_bytes) << ", with --points"
            << "\n  other output  depends on the holes found"
            << "\n  time          about " << print_duration(run.seconds) << ", " << assumption() << "\n";
}

void print_json(const std::vector<FileInfo>& files, const FilteredOut& filtered, const RunInfo& run) {
  Json root;
  root["files"] = Json::array();
  for (const FileInfo& file : files) {
    Json properties = Json::array();
    for (const Property& property : file.layout.properties) {
      properties.push_back({{"name", property.name}, {"type", ply_name(property.type)}});
    }
    root["files"].push_back({{"file", file.file.string()},
                             {"format", file.format},
                             {"points", file.points},
                             {"crs", file.crs.empty() ? Json() : Json(file.crs)},
                             {"properties", std::move(properties)}});
  }
  const Summary& summary = run.estimate.summary;
  const bool has_bounds = !summary.bounds.isEmpty();
  root["points"] = summary.counts.points;
  root["dropped"] = summary.counts.dropped - filtered.total();
  root["filtered_out"] = counts_of(filtered);
  root["bounds"] =
      has_bounds ? Json({{"min", list(summary.bounds.min())}, {"max", list(summary.bounds.max())}}) : Json();
  root["resolution"] = summary.resolution;
  root["thinned_out"] = summary.counts.thinned_out;
  root["tiles"] = summary.tiles;
  root["tile_points"] = summary.tile_points;
  root["cells"] = run.estimate.cells;
  root["cell_size"] = run.estimate.cell_size;
  root["memory_limit"] = summary.memory_limit;
  root["threads"] = summary.threads;
  root["workspace_bytes"] = run.estimate.workspace_bytes;
  root["points_file"] = run.points_file;
  root["points_bytes"] = run.points_bytes;
  root["estimated_seconds"] = run.seconds;
  root["estimate"] = assumption();
  std::cout << print(root, 2) << "\n";
}

void run_info(const InfoArguments& arguments) {
  const Config config = arguments.parameters.read().config;
  const ReadOptions options{.columns = config.input.columns};
  FileScan scan(expand_inputs(arguments.scans, options), config.input);
  std::vector<FileInfo> files;
  for (const fs::path& file : scan.files()) files.push_back(read_file_info(file, options));
  const RunInfo run = estimate_run(scan, config);
  if (arguments.json) {
    print_json(files, scan.filtered_out(), run);
  } else {
    print_text(files, scan.filtered_out(), run);
  }
}

}  // namespace

void add_info_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("info", "Show what scan files hold and what a run on them would take");
  const auto arguments = std::make_shared<InfoArguments>(*command);
  command
      ->add_option("SCAN", arguments->scans,
                   "Scan files, folders of them, or @LIST of their names; several are one registered scan")
      ->type_name("SCAN")
      ->required();
  command->add_flag("--json", arguments->json, "Print it as JSON");
  command->callback([arguments] { run_info(*arguments); });
}

}  // namespace lacuna::tools
