// SPDX-License-Identifier: Apache-2.0
// `lacuna detect`: from scan files to their holes on disk.
#pragma once

#include "engine/parts/kept_run.hpp"
#include "io/read/scan/scan_files.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/progress.hpp"
#include "tools/run/parameter_options.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace lacuna::tools {

// The options of commands that show their progress.
struct RunArguments {
  RunArguments(const Command& command, const ReadParameters& read);

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
  ResultArguments(const Command& command, const ReadParameters& read);

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
