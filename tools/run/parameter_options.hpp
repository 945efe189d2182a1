// SPDX-License-Identifier: Apache-2.0
// The command line's view of the parameters: one option each, generated from the list
// in io/options/. Constants of a method have none.
#pragma once

#include "io/options/options.hpp"
#include "tools/console/command_line.hpp"

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace lacuna::tools {

struct EffectiveConfig {
  io::FilesConfig config;
  // One for each parameter without effect that was given: on the command line with any value, in the config
  // file with another than the default. (A printed config has all parameters.)
  std::vector<std::string> warnings;
};

// Which parameters a command takes.
enum class ParameterScope {
  kRun,      // all, and `--config`
  kProcess,  // threads, memory and temporary files: a plan has the others
};

class ParameterOptions {
 public:
  // Adds an option for each parameter, grouped by section in --help.
  explicit ParameterOptions(const Command& command, ParameterScope scope = ParameterScope::kRun);

  // `config`, then the config file, then the command line. Throws `UsageError` for what is wrong in the file
  // and `WrongOption` for what is wrong on the command line.
  EffectiveConfig read(io::FilesConfig config = {}) const;

 private:
  // The file's name; empty: none was given.
  std::string read_file(io::FilesConfig& config, std::vector<std::string>& keys) const;
  std::vector<std::string> idle_warnings(io::FilesConfig config,
                                         const std::vector<std::string>& keys_in_file) const;

  struct Given {
    std::string text;
    std::optional<Option> option;  // none: of a constant

    bool is_given() const { return option && option->is_given(); }
  };
  std::string config_file_;
  std::deque<Given> given_;  // as in parameters(); a deque, because the options point into it
};

}  // namespace lacuna::tools
