// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/completion.hpp"

namespace lacuna::tools {
namespace {

constexpr std::string_view kConfigs = R"zsh(
_lacuna_configs() {
  local -a names=(${commands[lacuna]:h}/../share/lacuna/configs/*.toml(N:t:r))
  _alternative 'names:config:($names)' 'files:config file:_files -g "*.toml"'
}
)zsh";

// Within single quotes, and within [...] or :...: of an argument of _arguments.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string action_of(const OptionEntry& option) {
  switch (kind_of(option)) {
    case ValueKind::kChoice:
      return "(" + join(option.choices) + ")";
    case ValueKind::kFile:
      return "_files";
    case ValueKind::kFolder:
      return "_files -/";
    case ValueKind::kScan:
      return "_files -g \"*.(#i)(" + scan_endings("|") + ")\"";
    case ValueKind::kConfig:
      return "_lacuna_configs";
    case ValueKind::kFree:
      break;
  }
  return " ";
}

std::string argument(const std::string& text) {
  return " \\\n    '" + text + "'";
}

std::string option_arguments(const OptionEntry& option) {
  std::string arguments;
  const std::string others = option.names.size() > 1 ? "(" + join(option.names) + ")" : "";
  const std::string help = "[" + escaped(short_help(option)) + "]";
  for (const std::string& name : option.names) {
    const bool is_long = name.starts_with("--");
    if (option.value.empty()) {
      arguments += argument(others + name + help);
    } else {
      arguments += argument(others + name + (is_long ? "=" : "") + help + ":" + escaped(option.value) + ":" +
                            action_of(option));
    }
  }
  return arguments;
}

std::string function_of(const CommandEntry& command) {
  std::string name = "_" + command.name;
  for (char& c : name) {
    if (c == ' ') c = '_';
  }
  return name;
}

std::string define(const CommandEntry& command) {
  std::string arguments;
  for (const OptionEntry& option : command.options) arguments += option_arguments(option);
  const std::string function = function_of(command);
  if (command.commands.empty()) {
    std::size_t place = 0;
    for (const OptionEntry& positional : command.positionals) {
      arguments += argument((positional.is_repeated ? "*" : std::to_string(++place)) + ":" +
                            escaped(positional.names.front()) + ":" + action_of(positional));
    }
    return "\n" + function + "() {\n  _arguments -S" + arguments + "\n}\n";
  }
  std::string described, cases;
  for (const CommandEntry& below : command.commands) {
    described += "\n        '" + last_word(below) + ":" + escaped(below.help) + "'";
    cases += "        " + last_word(below) + ") " + function_of(below) + " ;;\n";
  }
  return "\n" + function + "() {\n  local context state line\n  local -a words_below\n  _arguments -C -S" +
         arguments + argument("1:command:->command") + argument("*::argument:->argument") +
         "\n  case $state in\n    command)\n      words_below=(" + described +
         ")\n      _describe command words_below ;;\n    argument)\n      case $line[1] in\n" + cases +
         "      esac ;;\n  esac\n}\n";
}

}  // namespace

std::string print_zsh_completion(const CommandEntry& program) {
  std::string script =
      "#compdef lacuna\n# Completion of lacuna in zsh, written by `lacuna completion zsh`.\n";
  script += kConfigs;
  for (const CommandEntry* command : all_commands(program)) script += define(*command);
  return script +
         "\n# Sourced, or loaded by its name in a folder of $fpath.\nif [[ $funcstack[1] == _lacuna ]]; "
         "then\n"
         "  _lacuna \"$@\"\nelse\n  compdef _lacuna lacuna\nfi\n";
}

}  // namespace lacuna::tools
