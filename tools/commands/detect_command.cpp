// SPDX-License-Identifier: Apache-2.0
#include "tools/commands/detect_command.hpp"

#include "engine/kept_state.hpp"
#include "engine/pipeline.hpp"
#include "engine/run/error.hpp"
#include "engine/run/job.hpp"
#include "engine/store/temporary_folder.hpp"
#include "engine/store/temporary_storage.hpp"
#include "io/area/check_area.hpp"
#include "io/results/results.hpp"
#include "io/scan/file_scan.hpp"
#include "io/stations/find_causes.hpp"
#include "tools/commands/commands.hpp"
#include "tools/commands/summary.hpp"
#include "tools/commands/workspace_commands.hpp"
#include "tools/console/area_text.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/progress.hpp"
#include "tools/console/terminal.hpp"
#include "tools/console/visible_text.hpp"
#include "tools/run/folders.hpp"
#include "tools/run/input_files.hpp"
#include "tools/run/own_process.hpp"
#include "tools/run/parameter_options.hpp"
#include "tools/run/scan_warnings.hpp"
#include "tools/run/signals.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Names are in the order of ProgressStyle.
constexpr std::array<std::string_view, 3> kProgressStyles = {"bar", "plain", "none"};

struct DetectArguments {
  explicit DetectArguments(const Command& command) : run(command) {}

  std::vector<fs::path> scans;
  bool print_config = false;
  ResultArguments run;
};

void require(const Command& command, const std::string& option) {
  if (!command.option(option).is_given()) throw WrongOption(option + " is required");
}

// The results replace all that their folder has.
void require_outside(const std::string& folder, const fs::path& out, const std::string& option) {
  if (folder.empty()) return;
  const fs::path within =
      fs::weakly_canonical(fs::absolute(folder)).lexically_relative(fs::weakly_canonical(fs::absolute(out)));
  if (!within.empty() && *within.begin() != "..")
    throw UsageError(folder + ": is in the folder of the results; allowed: another one for " + option);
}

// A workspace that this run alone uses.
struct UsedWorkspace {
  explicit UsedWorkspace(const fs::path& folder) : folder(folder), alone(this->folder.path()) {}
  MadeFolder folder;
  FolderLock alone;
};

// Returns nothing if the name is empty.
std::unique_ptr<UsedWorkspace> use_workspace(const std::string& name) {
  if (name.empty()) return nullptr;
  std::error_code error;
  auto used = std::make_unique<UsedWorkspace>(name);
  for (const fs::path& left : find_folders(used->folder.path(), "lacuna-"))
    fs::remove(left, error);  // if it is empty
  return used;
}

fs::path scratch_parent(const RunConfig& run, const ResultFolder& out) {
  if (!run.scratch.empty()) return run.scratch;
  return run.workspace.empty() ? out.temporary() : fs::path(run.workspace);
}

}  // namespace

RunArguments::RunArguments(const Command& command, ParameterScope scope) : parameters(command, scope) {
  const auto choose = [this](std::size_t style) { progress = static_cast<ProgressStyle>(style); };
  command
      .add_choice("--progress", kProgressStyles, choose,
                  "How stderr shows progress. The default is bar on a terminal, else plain")
      .rare();
  command.add_flag("--quiet", quiet, "Print no progress and no summary, only warnings and errors").rare();
}

FilesConfig RunArguments::start(FilesConfig base) const {
  auto [config, warnings] = parameters.read(std::move(base));
  if (quiet) quiet_log();
  print_warnings(warnings);
  prepare_process(config.run);
  return config;
}

std::unique_ptr<Progress> RunArguments::show_progress() const {
  return make_progress(quiet ? ProgressStyle::kNone : progress);
}

FilesConfig config_of(const KeptRun& run, const fs::path& workspace) {
  FilesConfig config;
  read_parameters(run.note, workspace, parameters(config));
  return config;
}

std::unique_ptr<FileScan> open_inputs(const std::vector<ScanInput>& inputs, const FilesConfig& config) {
  auto scan = std::make_unique<FileScan>(inputs, config.input, read_options(config).memory);
  require_lengths(*scan);
  print_warnings(input_warnings(*scan));
  return scan;
}

ResultArguments::ResultArguments(const Command& command, ParameterScope scope)
    : RunArguments(command, scope) {
  command
      .add_option("--out", out,
                  "Folder for the results: a new one, or one of earlier results, which they replace")
      .type("DIR");
}

std::string detect_to(const std::vector<ScanInput>& inputs, FilesConfig config,
                      const ResultArguments& arguments) {
  if (config.run.note.empty()) config.run.note = print_config(config);
  const Clock::time_point start = Clock::now();
  require_outside(config.run.workspace, arguments.out, "--workspace");
  require_outside(config.run.scratch, arguments.out, "--scratch");
  const std::unique_ptr<FileScan> opened = open_inputs(inputs, config);
  FileScan& scan = *opened;

  std::optional<Area> area = read_area(scan, config);
  const MadeFolder out_parent(parent_of(arguments.out));
  watch_results(arguments.out, arguments.out / "holes.json");  // from the first temporary file on
  ResultFolder out(arguments.out);
  check_results(scan, config, out);
  const std::unique_ptr<UsedWorkspace> workspace = use_workspace(config.run.workspace);
  if (workspace) {
    const fs::path& folder = workspace->folder.path();
    watch_workspace(folder);
    if (const std::optional<KeptState> state = state_of(folder))
      spdlog::info("goes on in {}: {}", folder.string(), print_state(*state));
  }
  const MadeFolder parent(scratch_parent(config.run, out));
  const TemporaryFolder scratch(parent.path(), "lacuna-");
  print_warnings(memory_warnings(config));
  const std::unique_ptr<Progress> progress = arguments.show_progress();

  const std::unique_ptr<StationViews> stations = watch_stations(scan, config.output, scratch.path());
  FilesConfig running = config;
  const bool is_in_memory = !stations && take_files_into_memory(scan, running.run);  // rays are files, too
  ExplainedDetection detection{*detect(scan, running, is_in_memory ? fs::path() : scratch.path(), *progress)};
  detection.summary.memory_limit = Memory::share(config.run.memory_limit).limit;  // files included
  if (stations) find_causes(*stations, scan, config.run, detection);
  if (area) detection.area = check_area(std::move(*area), scan, config, *progress);
  progress->begin("write", 0);
  const std::vector<fs::path> written = write_results(detection, scan, with_min_hole(config), out);
  note_complete_results();
  progress->end();
  if (detection.area) print_warnings(area_warnings(*detection.area));
  print_warnings(station_warnings(detection.stations));
  print_warnings(scan_warnings(scan, detection, config));

  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  std::string summary = print_summary(detection, scan, seconds);
  for (const fs::path& file : written) summary += "written: " + visible(file.string()) + "\n";
  if (workspace)
    summary += "kept: " + visible(config.run.workspace) +
               ", from which the same command goes on; lacuna clean removes it\n";
  return summary;
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
  const std::string summary = detect_to(expand_inputs(arguments.scans, config), config, arguments.run);
  if (!arguments.run.quiet) std::cout << summary;
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
