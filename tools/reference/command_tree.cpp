// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/command_tree.hpp"

#include <cctype>
#include <string_view>

#include <CLI/CLI.hpp>

namespace lacuna::tools {
namespace {

constexpr std::string_view kAllowed = " Allowed: ";

// A name of several values, "X Y Z", is no list of choices.
std::vector<std::string> split_choices(const std::string& value) {
  std::vector<std::string> choices;
  if (value.find('|') == value.npos) return choices;
  for (std::size_t begin = 0; begin <= value.size();) {
    const std::size_t end = std::min(value.find('|', begin), value.size());
    choices.push_back(value.substr(begin, end - begin));
    begin = end + 1;
  }
  return choices;
}

std::string as_sentence(std::string text) {
  if (text.empty()) return text;
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  if (text.back() != '.') text += '.';
  return text;
}

// Strings are quoted, as in the config file.
std::string without_quotes(const std::string& text) {
  const bool is_quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

OptionEntry describe(const CLI::Option& option) {
  OptionEntry entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  if (option.get_positional()) entry.names = {option.get_name(true)};
  if (option.get_items_expected_max() > 0) entry.value = option.get_type_name();
  entry.choices = split_choices(entry.value);
  entry.default_text = without_quotes(option.get_default_str());
  entry.help = as_sentence(option.get_description());
  if (option.get_group() != "Options") entry.section = option.get_group();
  entry.is_required = option.get_required();
  entry.is_repeated = option.get_items_expected_max() >= CLI::detail::expected_max_vector_size;
  return entry;
}

CommandEntry describe(const CLI::App& app, const std::string& name) {
  CommandEntry entry{.name = name, .help = app.get_description()};
  if (entry.help.ends_with('.')) entry.help.pop_back();
  for (const CLI::Option* option : app.get_options())
    (option->get_positional() ? entry.positionals : entry.options).push_back(describe(*option));
  for (const CLI::App* command : app.get_subcommands({}))
    entry.commands.push_back(describe(*command, name + " " + command->get_name()));
  return entry;
}

void append_commands(const CommandEntry& command, std::vector<const CommandEntry*>& all) {
  all.push_back(&command);
  for (const CommandEntry& below : command.commands) append_commands(below, all);
}

}  // namespace

CommandEntry command_tree(const CLI::App& app) {
  return describe(app, app.get_name());
}

std::string short_help(const OptionEntry& option) {
  std::string text = option.help.substr(0, option.help.find(kAllowed));
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::vector<const CommandEntry*> all_commands(const CommandEntry& root) {
  std::vector<const CommandEntry*> all;
  append_commands(root, all);
  return all;
}

std::string last_word(const CommandEntry& command) {
  return command.name.substr(command.name.rfind(' ') + 1);
}

}  // namespace lacuna::tools
