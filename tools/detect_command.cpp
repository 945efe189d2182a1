// SPDX-License-Identifier: Apache-2.0
#include "tools/detect_command.hpp"

#include "engine/pipeline.hpp"
#include "engine/run/error.hpp"
#include "engine/run/job.hpp"
#include "engine/store/temporary_folder.hpp"
#include "engine/workspace/workspace.hpp"
#include "engine/workspace/workspace_state.hpp"
#include "io/file_scan.hpp"
#include "io/results/results.hpp"
#include "io/stations/find_causes.hpp"
#include "tools/disk_check.hpp"
#include "tools/folders.hpp"
#include "tools/input_files.hpp"
#include "tools/log_file.hpp"
#include "tools/overall_progress.hpp"
#include "tools/own_process.hpp"
#include "tools/parameter_options.hpp"
#include "tools/scan_warnings.hpp"
#include "tools/shown_progress.hpp"
#include "tools/signals.hpp"
#include "tools/summary.hpp"
#include "tools/terminal.hpp"
#include "tools/value_options.hpp"
#include "tools/visible_text.hpp"
#include "tools/workspace_commands.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::array<Choice<ProgressStyle>, 4> kProgressStyles{{{"bar", ProgressStyle::kBar},
                                                                {"plain", ProgressStyle::kPlain},
                                                                {"json", ProgressStyle::kJson},
                                                                {"none", ProgressStyle::kNone}}};

struct DetectArguments {
  explicit DetectArguments(CLI::App& command) : run(command) {}

  std::vector<fs::path> scans;
  bool print_config = false;
  bool restart = false;
  ResultArguments run;
};

void require(const CLI::App& command, const std::string& option) {
  if (command.get_option(option)->count() == 0) throw CLI::RequiredError(option);
}

// A workspace that this run alone uses.
struct UsedWorkspace {
  explicit UsedWorkspace(const fs::path& folder) : folder(folder), alone(this->folder.path()) {}
  MadeFolder folder;
  FolderLock alone;
};

// None where the name is empty.
std::unique_ptr<UsedWorkspace> use_workspace(const std::string& name, const fs::path& out) {
  if (name.empty()) return nullptr;
  std::error_code error;
  if (fs::equivalent(name, out, error))
    throw UsageError(name + ": is the folder of the results, too; allowed: another one for --workspace");
  auto used = std::make_unique<UsedWorkspace>(name);
  for (const fs::path& left : find_folders(used->folder.path(), "lacuna-"))
    fs::remove(left, error);  // if it is empty
  return used;
}

void restart(const fs::path& workspace) {
  end_update(workspace);
  for (const fs::path& file : workspace_files(workspace)) remove_part(file);
}

fs::path scratch_parent(const RunConfig& run, const fs::path& out) {
  if (!run.scratch.empty()) return run.scratch;
  return run.workspace.empty() ? out : fs::path(run.workspace);
}

// Empty where every program reads what was written.
std::string readers_note(const FileScan& scan, const OutputConfig& config,
                         const std::vector<fs::path>& written) {
  if (scan.single_precision() || config.local_coordinates) return "";
  const bool has_pcd = std::any_of(written.begin(), written.end(),
                                   [](const fs::path& file) { return file.extension() == ".pcd"; });
  return std::string("note: PCL takes the 64-bit coordinates of ") + (has_pcd ? "PLY and PCD" : "PLY") +
         " files for 0 0 0" + (has_pcd ? ", Open3D those of PCD" : "") +
         "; --local-coordinates helps, or --points --points-format las or csv\n";
}

}  // namespace

RunArguments::RunArguments(CLI::App& command) : parameters(command) {
  add_choice(command, "--progress", kProgressStyles, progress,
             "How stderr shows progress, by default bar on a terminal, else plain; json is for programs");
  command.add_flag("--quiet", quiet, "No progress, no summary: only warnings and errors");
  command
      .add_option("--log-file", log_file,
                  "Append warnings, errors and the times of stages to this file, with the time of each")
      ->type_name("FILE");
}

FilesConfig RunArguments::start(FilesConfig base) const {
  auto [config, warnings] = parameters.read(std::move(base));
  if (quiet) quiet_log();
  if (!log_file.empty()) start_log_file(log_file);
  for (const std::string& warning : warnings) spdlog::warn("{}", warning);
  prepare_process(config.run);
  config.run.note = print_parameters(file_parameters(config));
  return config;
}

std::unique_ptr<Progress> RunArguments::show_progress(const Config& config) const {
  return make_progress(quiet ? ProgressStyle::kNone : progress, expected_stages(config));
}

FilesConfig config_of(const StoredRun& run, const fs::path& workspace) {
  FilesConfig config{run.config, {}, {}};
  read_parameters(run.note, workspace, file_parameters(config));
  return config;
}

std::unique_ptr<FileScan> open_inputs(const std::vector<ScanInput>& inputs, const FilesConfig& config) {
  auto scan =
      std::make_unique<FileScan>(inputs, config.input, Memory::share(config.run.memory_limit).reading);
  refuse_degrees(*scan);
  for (const std::string& warning : input_warnings(*scan)) spdlog::warn("{}", warning);
  return scan;
}

ResultArguments::ResultArguments(CLI::App& command) : RunArguments(command) {
  command.add_option("--out", out, "Folder for the results; created if missing")->type_name("DIR");
  command.add_flag("--overwrite", overwrite,
                   "Replace files that lacuna detect did not write, too, where results need their names");
}

std::string detect_to(const std::vector<ScanInput>& inputs, const FilesConfig& config,
                      const ResultArguments& arguments, const WorkspaceSteps& steps) {
  const Clock::time_point start = Clock::now();
  const Overwrite overwrite = arguments.overwrite ? Overwrite::kAny : Overwrite::kOwn;
  const std::unique_ptr<FileScan> opened = open_inputs(inputs, config);
  FileScan& scan = *opened;

  const MadeFolder out_folder(arguments.out);
  const fs::path& out = out_folder.path();
  const FolderLock alone(out);
  check_output_folder(scan, config, out, overwrite);
  watch_results(out, out / "holes.json");
  for (const fs::path& left : find_folders(out, kTemporaryPrefix))
    spdlog::warn("{}: left by a run that was killed, or kept on purpose; it can be removed", left.string());
  const std::unique_ptr<UsedWorkspace> workspace = use_workspace(config.run.workspace, out);
  if (workspace) {
    const fs::path& folder = workspace->folder.path();
    watch_workspace(folder);
    if (steps.begin) steps.begin();
    if (const std::optional<WorkspaceState> state = state_of_workspace(folder))
      spdlog::info("goes on in {}: {}", folder.string(), print_state(*state));
  }
  const MadeFolder parent(scratch_parent(config.run, out));
  const TemporaryFolder scratch(parent.path(), parent.path() == out ? kTemporaryPrefix : "lacuna-");
  for (const std::string& warning : memory_warnings(config)) spdlog::warn("{}", warning);
  for (const std::string& warning : check_disks(scan, config, parent.path(), out))
    spdlog::warn("{}", warning);
  const std::unique_ptr<Progress> progress = arguments.show_progress(config);

  const std::unique_ptr<StationViews> stations = watch_stations(scan, config.output, scratch.path());
  ExplainedDetection detection{*detect(scan, config, scratch.path(), *progress)};
  if (stations) find_causes(*stations, scan, config.run, detection);
  const Clock::time_point writing = Clock::now();
  progress->begin("write", 0);
  const std::vector<fs::path> written = write_results(detection, scan, with_min_hole(config), out, overwrite);
  note_complete_results();
  const std::string more = steps.end ? steps.end() : "";
  if (workspace) {
    write_note(workspace->folder.path(), WorkspaceNote::kResults, full_name(out).string());
    end_update(workspace->folder.path());
  }
  progress->end();
  for (const std::string& warning : station_warnings(detection.stations)) spdlog::warn("{}", warning);
  for (const std::string& warning : scan_warnings(scan, detection.summary, config))
    spdlog::warn("{}", warning);

  const Clock::time_point end = Clock::now();
  std::string summary = print_summary(detection, scan,
                                      {.write_seconds = std::chrono::duration<double>(end - writing).count(),
                                       .total_seconds = std::chrono::duration<double>(end - start).count()},
                                      scan.length_unit());
  for (const fs::path& file : written) summary += "written: " + visible(file.string()) + "\n";
  summary += readers_note(scan, config.output, written);
  if (workspace)
    summary += "kept: " + visible(config.run.workspace) +
               ", from which the same command goes on; lacuna clean removes it\n";
  return summary + more;
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
  if (arguments.run.out.empty()) throw CLI::ValidationError("--out", "a folder name is needed");
  const ReadOptions options{.columns = config.input.columns,
                            .memory = Memory::share(config.run.memory_limit).reading};
  WorkspaceSteps steps;
  if (arguments.restart) {
    if (config.run.workspace.empty()) throw UsageError("--restart needs --workspace");
    steps.begin = [&] { restart(config.run.workspace); };
  }
  const std::string summary =
      detect_to(expand_inputs(arguments.scans, options), config, arguments.run, steps);
  if (!arguments.run.quiet) std::cout << summary;
}

}  // namespace

void add_detect_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("detect", "Find the holes of a scan and write them to a folder");
  // Its life ends with the callback's, the app's own.
  const auto arguments = std::make_shared<DetectArguments>(*command);
  command
      ->add_option("SCAN", arguments->scans,
                   "Scan files, folders of them, or @LIST of their names; several are one registered scan")
      ->type_name("SCAN");
  command->add_flag("--print-config", arguments->print_config,
                    "Print the parameters in effect as a config file, and end");
  command->add_flag("--restart", arguments->restart,
                    "Begin anew: without what the workspace has of an earlier run");
  command->callback([command, arguments] { run_detect(*command, *arguments); });
}

}  // namespace lacuna::tools
