// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/completion.hpp"

namespace lacuna::tools {
namespace {

constexpr std::string_view kFunctions = R"bash(
# Files with one of the endings, all without any; folders too.
_lacuna_files() {
  local name ending
  mapfile -t COMPREPLY < <(compgen -d -- "$cur")
  while IFS= read -r name; do
    ending=${name##*.}
    if (($# == 0)) || [[ " $* " == *" ${ending,,} "* ]]; then COMPREPLY+=("$name"); fi
  done < <(compgen -f -- "$cur")
  compopt -o filenames 2>/dev/null
}

_lacuna_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

_lacuna_configs() {
  local folder file words=
  folder=$(dirname "$(type -P "${COMP_WORDS[0]}")" 2>/dev/null)/../share/lacuna/configs
  for file in "$folder"/*.toml; do
    [[ -e $file ]] && words+=" $(basename "$file" .toml)"
  done
  _lacuna_files toml
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$words" -- "$cur")
}

_lacuna() {
  local cur=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} at=lacuna i
  # The shell takes --option=value as three words.
  if [[ $cur == = ]]; then
    cur=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  COMPREPLY=()
)bash";

std::string complete_value(const OptionEntry& option) {
  switch (kind_of(option)) {
    case ValueKind::kChoice:
      return "_lacuna_words '" + join(option.choices) + "'";
    case ValueKind::kFile:
      return "_lacuna_files";
    case ValueKind::kFolder:
      return "_lacuna_files /";  // an ending that no file has
    case ValueKind::kScan:
      return "_lacuna_files " + scan_endings(" ");
    case ValueKind::kConfig:
      return "_lacuna_configs";
    case ValueKind::kFree:
      break;
  }
  return "";
}

// After an option that takes a value: the value.
std::string value_cases(const CommandEntry& command) {
  std::string cases;
  for (const OptionEntry& option : command.options) {
    if (option.value.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) patterns.push_back("'" + command.name + " " + name + "'");
    const std::string complete = complete_value(option);
    cases +=
        "    " + join(patterns, " | ") + ") " + (complete.empty() ? "" : complete + "; ") + "return ;;\n";
  }
  return cases;
}

std::string word_case(const CommandEntry& command) {
  std::vector<std::string> options, commands;
  for (const OptionEntry& option : command.options)
    options.insert(options.end(), option.names.begin(), option.names.end());
  for (const CommandEntry& below : command.commands) commands.push_back(last_word(below));
  std::string other;
  if (!commands.empty()) {
    other = "_lacuna_words '" + join(commands) + "'";
  } else if (!command.positionals.empty()) {
    other = complete_value(command.positionals.front());
  }
  return "    '" + command.name + "')\n      if [[ $cur == -* ]]; then _lacuna_words '" + join(options) +
         "'" + (other.empty() ? "" : "; else " + other) + "; fi ;;\n";
}

}  // namespace

std::string print_bash_completion(const CommandEntry& program) {
  const std::vector<const CommandEntry*> commands = all_commands(program);
  std::vector<std::string> below;
  for (const CommandEntry* command : commands) {
    if (command != &program) below.push_back("'" + command->name + "'");
  }
  std::string script = "# Completion of lacuna in bash, written by `lacuna completion bash`.\n";
  script += kFunctions;
  script += "  for ((i = 1; i < COMP_CWORD; i++)); do\n    case \"$at ${COMP_WORDS[i]}\" in\n      " +
            join(below, " | ") + ") at+=\" ${COMP_WORDS[i]}\" ;;\n    esac\n  done\n";
  script += "  case \"$at $previous\" in\n";
  for (const CommandEntry* command : commands) script += value_cases(*command);
  script += "  esac\n  case \"$at\" in\n";
  for (const CommandEntry* command : commands) script += word_case(*command);
  script += "  esac\n}\ncomplete -F _lacuna lacuna\n";
  return script;
}

}  // namespace lacuna::tools
