// SPDX-License-Identifier: Apache-2.0
// `lacuna detect`: from scan files to their holes on disk. `lacuna check`: whether a scan covers an area; it
// reads the scan once and finds no loops.
#include "engine/kept_state.hpp"
#include "engine/pipeline.hpp"
#include "engine/store/temporary_folder.hpp"
#include "io/explain/area/check_area.hpp"
#include "io/explain/stations/find_causes.hpp"
#include "io/read/scan/scan_pass.hpp"
#include "io/write/results/results.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/input_files.hpp"
#include "tools/run/run_program.hpp"
#include "tools/run/scan_warnings.hpp"

#include <array>
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Names are in the order of ProgressStyle.
constexpr std::array<std::string_view, 4> kProgressStyles = {"bar", "plain", "json", "none"};

struct DetectArguments {
  explicit DetectArguments(CLI::App& command) : run(command, parameters_of_run()) {}

  std::vector<fs::path> scans;
  bool print_config = false;
  ResultArguments run;
};

void require(const CLI::App& command, const std::string& option) {
  if (command.count(option) == 0) throw WrongOption(option + " is required");
}

fs::path scratch_parent(const RunConfig& run, const ResultFolder& results) {
  if (!run.scratch.empty()) return run.scratch;
  return run.workspace.empty() ? results.temporary() : fs::path(run.workspace);
}

// Makes the kept folder of a run, if it has one.
std::unique_ptr<KeptFolder> use_workspace(const fs::path& folder) {
  if (folder.empty()) return nullptr;
  auto workspace = std::make_unique<KeptFolder>(folder);
  remove_leftovers(workspace->path(), kScratchPrefix);
  watch_workspace(workspace->path());
  if (const std::optional<KeptState> state = state_of(workspace->path()))
    spdlog::info("goes on in {}: {}", workspace->path().string(), print_state(*state));
  return workspace;
}

// What a run holds until its results are written. Each member may use the ones before, and goes before them.
struct RunResources {
  RunResources(const std::vector<ScanInput>& inputs, const FilesConfig& config,
               const ResultArguments& arguments)
      : scan(open_inputs(inputs, config)), out(arguments.out, "holes.json") {
    check_results(scan, config, out.results());
    workspace = use_workspace(config.run.workspace);
    scratch.emplace(scratch_parent(config.run, out.results()));
    print_warnings(memory_warnings(config));
    progress = arguments.show_progress(steps_of_run(config));
    stations = watch_stations(scan, config.output, scratch->path());
  }

  ScanFiles scan;
  OutFolder out;                           // no other run may take its name meanwhile
  std::unique_ptr<KeptFolder> workspace;   // null: nothing is kept
  std::optional<ScratchFolder> scratch;    // in one of these two folders, unless it has its own place
  std::unique_ptr<Progress> progress;      // its line ends before the folders go
  std::unique_ptr<StationViews> stations;  // have files in the scratch folder
};

}  // namespace

RunArguments::RunArguments(CLI::App& command, const ReadParameters& read) : parameters(command, read) {
  const auto choose = [this](std::size_t style) { progress = static_cast<ProgressStyle>(style); };
  add_choice(command, "--progress", kProgressStyles, choose,
             "How stderr shows progress. The default is bar on a terminal, else plain")
      ->group(kRareOptions);
  command.add_flag("--quiet", quiet, "Print no progress and no summary, only warnings and errors")
      ->group(kRareOptions);
}

FilesConfig RunArguments::start(FilesConfig base) const {
  if (quiet) quiet_log();
  return parameters.start(std::move(base));
}

std::unique_ptr<Progress> RunArguments::show_progress(RunSteps steps) const {
  return make_progress(quiet ? ProgressStyle::kNone : progress, std::move(steps));
}

FilesConfig config_of(const KeptRun& run, const fs::path& workspace) {
  FilesConfig config;
  read_parameters(run.note, workspace, parameters(config));
  config.run.workspace = workspace.string();
  return config;
}

ScanFiles open_inputs(const std::vector<ScanInput>& inputs, const FilesConfig& config) {
  ScanFiles scan(inputs, config.input, read_options(config).memory);
  require_lengths(scan);
  print_warnings(input_warnings(scan));
  return scan;
}

ResultArguments::ResultArguments(CLI::App& command, const ReadParameters& read)
    : RunArguments(command, read) {
  command
      .add_option("--out", out,
                  "Folder for the results: a new one, or one of earlier results, which they replace")
      ->type_name("DIR");
}

void detect_to(const std::vector<ScanInput>& inputs, FilesConfig config, const ResultArguments& arguments) {
  if (config.run.note.empty()) config.run.note = print_config(config);
  const Clock::time_point start = Clock::now();
  require_outside_results(config.run.workspace, arguments.out, "--workspace");
  require_outside_results(config.run.scratch, arguments.out, "--scratch");
  RunResources run(inputs, config, arguments);
  ScanPass pass(run.scan, run.stations.get());
  const std::unique_ptr<Detection> found = detect(pass, config, run.scratch->path(), *run.progress);
  ExplainedDetection detection(*found, pass.counts());
  if (run.stations) find_causes(*run.stations, config.run, detection);
  run.progress->begin("write", 0);
  const auto written = write_results(detection, run.scan, with_min_hole(config), run.out.results());
  note_complete_results();
  run.progress->end();
  print_warnings(station_warnings(detection.stations, detection.points_of_none, detection.upward));
  print_warnings(scan_warnings(run.scan, detection, config));

  if (arguments.quiet) return;
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  std::string summary = print_summary(detection, run.scan, seconds);
  for (const fs::path& file : written) summary += "written: " + visible(file.string()) + "\n";
  if (run.workspace)
    summary += "kept: " + visible(config.run.workspace) +
               ", from which the same command goes on; lacuna clean removes it\n";
  std::cout << summary;
}

namespace {

void run_detect(const CLI::App& command, const DetectArguments& arguments) {
  if (arguments.print_config) {
    std::cout << print_config(arguments.run.parameters.read().config);
    return;
  }
  const FilesConfig config = arguments.run.start();
  require(command, "SCAN");
  require(command, "--out");
  if (arguments.run.out.empty()) throw WrongOption("--out", "a folder name is needed");
  detect_to(expand_inputs(arguments.scans, config), config, arguments.run);
}

}  // namespace

void add_detect_command(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("detect", "Find the holes of a scan and write them to a folder");
  // Its life ends with the callback's, the app's own.
  const auto arguments = std::make_shared<DetectArguments>(command);
  add_scans(command, arguments->scans);
  command
      .add_flag("--print-config", arguments->print_config,
                "Print the parameters in effect as a config file, and end")
      ->group(kRareOptions);
  command.callback([&command, arguments] { run_detect(command, *arguments); });
}

namespace {

struct CheckArguments {
  explicit CheckArguments(CLI::App& command) : run(command, parameters_of_check()) {}

  std::vector<fs::path> scans;
  ResultArguments run;
};

// Throws `AnswerIsNo` unless the scan covers the area, so that scripts see it.
void run_check(const CheckArguments& arguments) {
  FilesConfig base;
  base.area.is_check = true;
  const FilesConfig config = arguments.run.start(std::move(base));
  if (config.area.area_tile > 0 && arguments.run.out.empty())
    spdlog::warn("--area-tile changes nothing without --out");
  if (config.output.report && arguments.run.out.empty())
    spdlog::warn("--report changes nothing without --out");
  const ScanFiles scan = open_inputs(expand_inputs(arguments.scans, config), config);
  std::optional<OutFolder> out;
  if (!arguments.run.out.empty()) {
    out.emplace(arguments.run.out, kVoidsFile);
    check_not_input(out->results(), scan);
  }
  const std::unique_ptr<Progress> progress = arguments.run.show_progress();
  const AreaCheck check = check_scan(scan, config, *progress);
  print_warnings(area_warnings(check, scan.length_unit()));
  Eigen::AlignedBox3d bounds;
  for (const AreaPolygon& polygon : check.polygons)
    for (const Eigen::Vector2d& corner : polygon.outline.front())
      bounds.extend(Eigen::Vector3d(corner.x(), corner.y(), 0));
  print_warnings(filter_warnings(scan, check.counts, bounds));
  const std::string_view unit = scan.length_unit();
  std::string text = print_check(check, unit);
  if (out) {
    for (const auto& file : write_voids(check, scan, config, out->results()))
      text += "written: " + visible(file.string()) + "\n";
    note_complete_results();
  }
  if (!arguments.run.quiet) std::cout << text;
  if (!check.is_covered())
    throw AnswerIsNo{
        (check.is_outline ? "outline of the scan" : config.area.area) + ": " + print_answer(check, unit),
        check.answer() == AreaAnswer::kVoids};
}

}  // namespace

void add_check_command(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("check", "Check whether a scan covers an area, without finding its loops");
  const auto arguments = std::make_shared<CheckArguments>(command);
  add_scans(command, arguments->scans)->required();
  command.get_option("--report")
      ->description("Write report.html too: one sheet with the answer and a map, for acceptance.");
  command.callback([arguments] { run_check(*arguments); });
}

}  // namespace lacuna::tools
