// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/completion.hpp"

namespace lacuna::tools {
namespace {

constexpr std::string_view kConfigs = R"fish(
function __lacuna_configs
    for file in (dirname (command -s lacuna))/../share/lacuna/configs/*.toml
        basename $file .toml
    end
    __fish_complete_suffix .toml
end
)fish";

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

std::string action_of(const OptionEntry& option) {
  switch (kind_of(option)) {
    case ValueKind::kChoice:
      return " -x -a " + quoted(join(option.choices));
    case ValueKind::kFile:
      return " -r -F";
    case ValueKind::kFolder:
      return " -x -a '(__fish_complete_directories)'";
    case ValueKind::kScan:
      return " -x -a '(__fish_complete_suffix ." + scan_endings(" .") + ")'";
    case ValueKind::kConfig:
      return " -x -a '(__lacuna_configs)'";
    case ValueKind::kFree:
      break;
  }
  return " -x";
}

std::string complete(const CommandEntry& command) {
  const std::string begin = "complete -c lacuna -n '__lacuna_at " + command.name + "'";
  std::string lines = "\n";
  for (const CommandEntry& below : command.commands)
    lines += begin + " -a " + last_word(below) + " -d " + quoted(below.help) + "\n";
  if (command.commands.empty() && !command.positionals.empty()) {
    const OptionEntry& positional = command.positionals.front();
    std::string action = action_of(positional);
    if (action.starts_with(" -x")) action.erase(0, 3);  // of options alone
    if (action == " -r -F") action = " -F";
    if (!action.empty()) lines += begin + action + " -d " + quoted(short_help(positional)) + "\n";
  }
  for (const OptionEntry& option : command.options) {
    lines += begin;
    for (const std::string& name : option.names)
      lines += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    lines += (option.value.empty() ? "" : action_of(option)) + " -d " + quoted(short_help(option)) + "\n";
  }
  return lines;
}

}  // namespace

std::string print_fish_completion(const CommandEntry& program) {
  const std::vector<const CommandEntry*> commands = all_commands(program);
  std::vector<std::string> below;
  for (const CommandEntry* command : commands) {
    if (command != &program) below.push_back("'" + command->name + "'");
  }
  std::string script = "# Completion of lacuna in fish, written by `lacuna completion fish`.\n";
  script +=
      "\n# Whether the words so far name this command.\nfunction __lacuna_at\n    set -l at lacuna\n"
      "    for word in (commandline -opc)[2..-1]\n        switch \"$at $word\"\n            case " +
      join(below) +
      "\n                set at \"$at $word\"\n        end\n    end\n    test \"$at\" = \"$argv\"\nend\n";
  script += kConfigs;
  script += "\ncomplete -c lacuna -f\n";
  for (const CommandEntry* command : commands) script += complete(*command);
  return script;
}

}  // namespace lacuna::tools
