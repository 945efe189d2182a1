// SPDX-License-Identifier: Apache-2.0
// The command line: what the programs add to CLI11. This is help of two lengths, hints about wrong words, and
// errors of one line. CLI11 takes eight seconds of each source that includes it, so this header does not.
#pragma once

#include "engine/run/error.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace lacuna::tools {

// The user has given options that are not possible. The program adds to the message how to get help.
class WrongOption : public UsageError {
 public:
  explicit WrongOption(const std::string& reason) : UsageError(reason) {}
  WrongOption(const std::string& option, const std::string& reason) : UsageError(option + ": " + reason) {}
};

// Checks of a value. An error names what is allowed.
// CLI11 alone makes a number near 2^64 of -1.
CLI::Validator whole_number(std::size_t least = 0, std::size_t most = -1);
CLI::Validator real_number();
CLI::Validator name_ending_in(const std::string& ending);  // also in upper case

// Adds an option that takes one of `names`. `choose` gets its place among them.
CLI::Option* add_choice(CLI::App& command, const std::string& name, std::span<const std::string_view> names,
                        const std::function<void(std::size_t)>& choose, const std::string& help);

// Before the group of an option that --help-all alone shows.
constexpr std::string_view kRare = "rare: ";
constexpr const char* kRareOptions = "rare: Options";

// A whole program with its commands. They refer to the variables of their options until the program ends.
class CommandLine {
 public:
  // `version` is the text that --version prints.
  CommandLine(const std::string& name, const std::string& help, const std::string& version);
  ~CommandLine();

  CLI::App& program() const { return *app_; }

  // Runs the command that the arguments name, or prints help. `help COMMAND` is the same as `COMMAND --help`.
  // Throws `UsageError` if the arguments are not possible, and any error that the command throws.
  void run(std::vector<std::string> arguments);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace lacuna::tools
