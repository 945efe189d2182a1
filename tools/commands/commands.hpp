// SPDX-License-Identifier: Apache-2.0
// The commands of `lacuna`. Each function adds one to the program, with its options. The command runs when it
// is parsed. It throws `Error` when the job fails, and `UsageError` for options that are not possible.
#pragma once

#include "engine/kept_state.hpp"
#include "engine/parts/kept_run.hpp"
#include "io/explain/area/area_check.hpp"
#include "io/explain/stations/cause.hpp"
#include "io/read/options/options.hpp"
#include "io/read/scan/scan_files.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/progress.hpp"

#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::tools {

// The parameters that a command reads, by their keys or the names of their sections. Others are no options of
// it. A config file may have them, since one file serves all commands. They keep their defaults then.
struct ReadParameters {
  std::vector<std::string_view> common;  // which --help shows
  std::vector<std::string_view> rare;    // which --help-all alone shows
  bool has_config_file = true;           // takes `--config`

  bool has(const Parameter& parameter) const;
};

// Returns all parameters, those of a run.
ReadParameters parameters_of_run();
// Returns those of a check of an area.
ReadParameters parameters_of_check();
// Returns those that `lacuna info` reads.
ReadParameters parameters_of_info();
// Returns those of a process that does a part of a plan, which has the others.
ReadParameters parameters_of_process();

struct EffectiveConfig {
  io::FilesConfig config;
  // One for each parameter without effect that was given: on the command line with any value, in the config
  // file with another than the default. (A printed config has all parameters.)
  std::vector<std::string> warnings;
};

class ParameterOptions {
 public:
  // Adds an option for each parameter that is read, grouped by section in --help-all. One that a file alone
  // sets is refused with the words that say so.
  ParameterOptions(CLI::App& command, const ReadParameters& read);

  // `config`, then the config file, then the command line. Throws `UsageError` for what is wrong in the file
  // and `WrongOption` for what is wrong on the command line.
  EffectiveConfig read(io::FilesConfig config = {}) const;

  // Returns the same config. Prints the warnings, and prepares the process for the run.
  io::FilesConfig start(io::FilesConfig config = {}) const;

 private:
  // Takes what is read from the file. Returns its name; empty: none was given.
  std::string take_file(io::FilesConfig& config, std::vector<std::string>& keys) const;
  std::vector<std::string> idle_warnings(io::FilesConfig config,
                                         const std::vector<std::string>& keys_in_file) const;

  struct Given {
    bool is_read = false;
    std::string text;
    CLI::Option* option = nullptr;  // none: of a file alone, or not read

    bool is_given() const;
  };
  std::string config_file_;
  std::deque<Given> given_;  // as in parameters(); a deque, because the options point into it
};

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

// The summary that a person reads after a run.

// Returns the counts of loops, the largest holes by area, and facts of the scan and of the run.
std::string print_summary(const io::ExplainedDetection& detection, const io::ScanFiles& scan, double seconds);

// Returns points that do not take part, by reason: "; 12 not finite, dropped; 3 outside of the bounds".
std::string print_left_out(const Counts& counts, const io::FilteredOut& filtered);

// lacuna status and lacuna clean: the content of a workspace, and its removal.

// Returns "level 0: 12 of 20 tiles evaluated; level 1: ...".
std::string print_state(const KeptState& state);

// The check of an area as a person reads it.

// "covered", or "voids: 3 of 2.8 m or more (2 holes, 1 open), 1 more in exceptions", or "not decided" with
// its reasons.
std::string print_answer(const io::AreaCheck& check, std::string_view unit);

// Returns the answer, a table of the ten largest voids, the area and its covered share. What the figures rest
// on follows, and what the check does not show.
std::string print_check(const io::AreaCheck& check, std::string_view unit);

// Returns lines for points that cover nothing as their heights lie apart, and for densities that may be
// wrong.
std::vector<std::string> area_warnings(const io::AreaCheck& check, std::string_view unit);

}  // namespace lacuna::tools
