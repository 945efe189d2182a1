// SPDX-License-Identifier: Apache-2.0
// The commands and options of the program as plain data: what manual pages and completions are written from.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace lacuna::tools {

struct OptionEntry {
  std::vector<std::string> names;    // "-h", "--help"; of a positional argument its one name, "SCAN"
  std::string value;                 // what it takes: "FILE", "X", "bar|plain|none"; empty: a flag
  std::vector<std::string> choices;  // of a value such as "bar|plain|none"
  std::string default_text;          // empty: none
  std::string help;                  // sentences, the last with a full stop
  std::string section;               // of the config file, for parameters; else empty
  bool is_required = false;
  bool is_repeated = false;  // takes any number of values
};

struct CommandEntry {
  std::string name;  // "lacuna synth surface"
  std::string help;  // one sentence, without a full stop
  std::vector<OptionEntry> positionals;
  std::vector<OptionEntry> options;
  std::vector<CommandEntry> commands;
};

// The app with all that was added to it, in the order of --help.
CommandEntry command_tree(const CLI::App& app);

// The help without the list of what is allowed: for one line of a terminal.
std::string short_help(const OptionEntry& option);

// The command, the commands in it, and so on: each before those in it.
std::vector<const CommandEntry*> all_commands(const CommandEntry& root);

// "surface" of "lacuna synth surface".
std::string last_word(const CommandEntry& command);

}  // namespace lacuna::tools
