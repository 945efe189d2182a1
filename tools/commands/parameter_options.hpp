// SPDX-License-Identifier: Apache-2.0
// The command line's view of the parameters: one option each, generated from the list
// in io/read/options/. Constants of a method have none.
#pragma once

#include "io/read/options/options.hpp"
#include "tools/console/command_line.hpp"

#include <deque>
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
  // Adds an option for each parameter that is read, grouped by section in --help-all.
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
    CLI::Option* option = nullptr;  // none: of a constant, or of a parameter that is not read

    bool is_given() const;
  };
  std::string config_file_;
  std::deque<Given> given_;  // as in parameters(); a deque, because the options point into it
};

}  // namespace lacuna::tools
