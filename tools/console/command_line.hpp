// SPDX-License-Identifier: Apache-2.0
// The command line: commands, their options, and the help that shows them. CLI11 does the work. It takes ten
// seconds of each source that includes it, so that `command_line.cpp` alone does.
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
}  // namespace CLI

namespace lacuna::tools {

// The user has given options that are not possible. The program adds to the message how to get help.
class WrongOption : public UsageError {
 public:
  explicit WrongOption(const std::string& reason) : UsageError(reason) {}
  WrongOption(const std::string& option, const std::string& reason) : UsageError(option + ": " + reason) {}
};

// An option, or an argument without a name. Copies stand for the same one.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  const Option& required() const;
  const Option& type(const std::string& name) const;     // "DIR": what it takes, for the help
  const Option& section(const std::string& name) const;  // of --help-all
  const Option& help(const std::string& text) const;     // in place of the earlier one
  const Option& show_default() const;                    // the variable's value at this moment
  // The default as the config file has it. An empty one is not shown.
  const Option& show_default(const std::string& text) const;
  const Option& excludes(const Option& other) const;
  const Option& once() const;             // a second time is an error
  const Option& joined_by_comma() const;  // may be given again: the texts become one
  const Option& rare() const;             // only --help-all shows it

  // These restrict the values. An error names the restriction.
  // CLI11 alone makes a number near 2^64 of -1.
  const Option& whole_number(std::size_t least = 0, std::size_t most = -1) const;
  const Option& real_number() const;
  const Option& name_ending_in(const std::string& ending) const;  // also in upper case

  bool is_given() const;

 private:
  CLI::Option* option_;
};

// A command. It refers to its options' variables until the program ends.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command add_command(const std::string& name, const std::string& help) const;

  // "--name", or "NAME" for an argument without a name. T: a number, a text, a path, several or a list of
  // these, or an optional one; command_line.cpp has the list.
  template <class T>
  Option add_option(const std::string& name, T& value, const std::string& help) const;
  // T: bool, or a text that becomes "true" or "false".
  template <class T>
  Option add_flag(const std::string& name, T& value, const std::string& help) const;
  // Takes one of `names`. `choose` gets its place among them.
  Option add_choice(const std::string& name, std::span<const std::string_view> names,
                    const std::function<void(std::size_t)>& choose, const std::string& help) const;

  Option option(const std::string& name) const;  // one that was added before

  // The command needs one of the commands that were added to it.
  void needs_command() const;

  // The command does this. It may throw.
  void runs(const std::function<void()>& action) const;

 private:
  CLI::App* app_;
};

// A whole program with its commands.
class CommandLine {
 public:
  // `version` is the text that --version prints.
  CommandLine(const std::string& name, const std::string& help, const std::string& version);
  ~CommandLine();

  Command program() const;

  // Runs the command that the arguments name, or prints help. `help COMMAND` is the same as `COMMAND --help`.
  // Throws `UsageError` if the arguments are not possible, and any error that the command throws.
  void run(std::vector<std::string> arguments);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace lacuna::tools
