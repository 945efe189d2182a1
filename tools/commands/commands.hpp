// SPDX-License-Identifier: Apache-2.0
// The commands of `lacuna`. Each function adds one to the program, with its options. The command runs when it
// is parsed. It throws `Error` when the job fails, and `UsageError` for options that are not possible.
#pragma once

#include "engine/parts/kept_run.hpp"
#include "io/read/scan/scan_files.hpp"
#include "tools/commands/parameter_options.hpp"
#include "tools/console/progress.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace lacuna::tools {

// These start with a scan.
void add_detect_command(CLI::App& program);
void add_info_command(CLI::App& program);
void add_check_command(CLI::App& program);

// These start with the results of a run.
void add_report_command(CLI::App& program);
void add_render_command(CLI::App& program);
void add_compare_command(CLI::App& program);

// These find places for scanners: the next ones, and the past ones.
void add_stations_command(CLI::App& program);

// Runs that go on from a workspace.
void add_status_command(CLI::App& program);
void add_clean_command(CLI::App& program);

// Runs that several processes share, such as a job array of Slurm.
void add_plan_command(CLI::App& program);
void add_work_command(CLI::App& program);
void add_finish_command(CLI::App& program);

// `lacuna info`: what scan files hold, and what a run on them would take.

// Returns what `lacuna info --json` prints. Its warnings take the place of `warnings`. Throws `Error`.
std::string info_json(const std::vector<std::filesystem::path>& scans, const io::FilesConfig& config,
                      std::vector<std::string>& warnings);

// What several commands have.

// Adds the argument SCAN, for `expand_inputs`.
CLI::Option* add_scans(CLI::App& command, std::vector<std::filesystem::path>& scans);

// Adds the argument DIR of commands that begin with the results of a run.
CLI::Option* add_results_folder(CLI::App& command, std::filesystem::path& folder);

// The options of commands that show their progress.
struct RunArguments {
  RunArguments(CLI::App& command, const ReadParameters& read);

  // Returns the parameters over the ones in `base`. Sets up the log, and starts as `ParameterOptions` does.
  io::FilesConfig start(io::FilesConfig base = {}) const;

  // `steps`: of the run, for its share; none where it is not known.
  std::unique_ptr<Progress> show_progress(RunSteps steps = steps_of_check()) const;

  ProgressStyle progress = default_progress_style();
  bool quiet = false;
  ParameterOptions parameters;
};

// The options of commands that also write results.
struct ResultArguments : RunArguments {
  ResultArguments(CLI::App& command, const ReadParameters& read);

  std::filesystem::path out;
};

// The parameters of a run that a workspace keeps.
io::FilesConfig config_of(const KeptRun& run, const std::filesystem::path& workspace);

// Opens the files of a run as one scan. Warns of oddities, and refuses degrees. Throws `Error`.
io::ScanFiles open_inputs(const std::vector<io::ScanInput>& inputs, const io::FilesConfig& config);

// Finds the holes and writes the results. Prints their summary, unless the arguments are quiet.
void detect_to(const std::vector<io::ScanInput>& inputs, io::FilesConfig config,
               const ResultArguments& arguments);

}  // namespace lacuna::tools
