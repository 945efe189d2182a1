// SPDX-License-Identifier: Apache-2.0
#include "tools/commands/detect_command.hpp"

#include "engine/kept_state.hpp"
#include "engine/pipeline.hpp"
#include "engine/store/temporary_folder.hpp"
#include "io/explain/area/check_area.hpp"
#include "io/explain/stations/find_causes.hpp"
#include "io/read/scan/scan_pass.hpp"
#include "io/write/results/results.hpp"
#include "tools/commands/commands.hpp"
#include "tools/commands/summary.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/folders.hpp"
#include "tools/run/input_files.hpp"
#include "tools/run/run_program.hpp"
#include "tools/run/scan_warnings.hpp"

#include <array>
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Names are in the order of ProgressStyle.
constexpr std::array<std::string_view, 4> kProgressStyles = {"bar", "plain", "json", "none"};

struct DetectArguments {
  explicit DetectArguments(const Command& command) : run(command, parameters_of_run()) {}

  std::vector<fs::path> scans;
  bool print_config = false;
  ResultArguments run;
};

void require(const Command& command, const std::string& option) {
  if (!command.option(option).is_given()) throw WrongOption(option + " is required");
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
      : scan(open_inputs(inputs, config)), area(read_area(scan, config)), out(arguments.out, "holes.json") {
    check_results(scan, config, out.results());
    workspace = use_workspace(config.run.workspace);
    scratch.emplace(scratch_parent(config.run, out.results()));
    print_warnings(memory_warnings(config));
    progress = arguments.show_progress(steps_of_run(config, area.has_value()));
    stations = watch_stations(scan, config.output, scratch->path());
  }

  ScanFiles scan;
  std::optional<Area> area;                // before any folder is made: a file that is refused leaves none
  OutFolder out;                           // no other run may take its name meanwhile
  std::unique_ptr<KeptFolder> workspace;   // null: nothing is kept
  std::optional<ScratchFolder> scratch;    // in one of these two folders, unless it has its own place
  std::unique_ptr<Progress> progress;      // its line ends before the folders go
  std::unique_ptr<StationViews> stations;  // have files in the scratch folder
};

}  // namespace

RunArguments::RunArguments(const Command& command, const ReadParameters& read) : parameters(command, read) {
  const auto choose = [this](std::size_t style) { progress = static_cast<ProgressStyle>(style); };
  command
      .add_choice("--progress", kProgressStyles, choose,
                  "How stderr shows progress. The default is bar on a terminal, else plain")
      .rare();
  command.add_flag("--quiet", quiet, "Print no progress and no summary, only warnings and errors").rare();
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

ResultArguments::ResultArguments(const Command& command, const ReadParameters& read)
    : RunArguments(command, read) {
  command
      .add_option("--out", out,
                  "Folder for the results: a new one, or one of earlier results, which they replace")
      .type("DIR");
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
  if (run.area) detection.area = check_area(std::move(*run.area), run.scan, config, *run.progress);
  run.progress->begin("write", 0);
  const auto written = write_results(detection, run.scan, with_min_hole(config), run.out.results());
  note_complete_results();
  run.progress->end();
  if (detection.area) print_warnings(area_warnings(*detection.area, run.scan.length_unit()));
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

void run_detect(const Command& command, const DetectArguments& arguments) {
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

void add_detect_command(const Command& program) {
  const Command command =
      program.add_command("detect", "Find the holes of a scan and write them to a folder");
  // Its life ends with the callback's, the app's own.
  const auto arguments = std::make_shared<DetectArguments>(command);
  add_scans(command, arguments->scans);
  command
      .add_flag("--print-config", arguments->print_config,
                "Print the parameters in effect as a config file, and end")
      .rare();
  command.runs([command, arguments] { run_detect(command, *arguments); });
}

}  // namespace lacuna::tools
