// SPDX-License-Identifier: Apache-2.0
// The command line's view of the parameters: one option each, generated from the
// list in io/options/. Constants of a method have none.
#pragma once

#include "io/options/options.hpp"

#include <deque>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lacuna::tools {

struct EffectiveConfig {
  io::FilesConfig config;
  // One for each parameter without effect that was given: on the command line with any value, in the config
  // file with another than the default. (A printed config has all parameters.)
  std::vector<std::string> warnings;
};

class ParameterOptions {
 public:
  // Adds `--config` and an option for every parameter, grouped by section in --help.
  explicit ParameterOptions(CLI::App& command);

  // `config`, then the config file, then the command line. Throws `UsageError` for what is wrong in the file
  // and `CLI::ValidationError` for what is wrong on the command line.
  EffectiveConfig read(io::FilesConfig config = {}) const;

 private:
  // The file's name; empty: none was given.
  std::string read_file(io::FilesConfig& config, std::vector<std::string>& keys) const;
  std::vector<std::string> idle_warnings(io::FilesConfig config,
                                         const std::vector<std::string>& keys_in_file) const;

  struct Given {
    bool is_given() const;

    const CLI::Option* option = nullptr;  // of a constant: none
    std::string text;
  };
  std::string config_file_;
  std::deque<Given> given_;  // as in parameters(); a deque, because the options point into it
};

// `--columns x y z` with its names as one argument, `--columns=x y z`: all that follow up to the next option;
// only the first where it holds several names already.
std::vector<std::string> join_columns(std::vector<std::string> arguments);

}  // namespace lacuna::tools
