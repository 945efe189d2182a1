// SPDX-License-Identifier: Apache-2.0
#include "tools/reference_commands.hpp"

#include "engine/run/error.hpp"
#include "tools/reference/completion.hpp"
#include "tools/reference/man_page.hpp"
#include "tools/value_options.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace lacuna::tools {
namespace {

using PrintCompletion = std::string (*)(const CommandEntry& program);

constexpr std::array<Choice<PrintCompletion>, 3> kShells{
    {{"bash", print_bash_completion}, {"zsh", print_zsh_completion}, {"fish", print_fish_completion}}};

// Today, or the day that SOURCE_DATE_EPOCH names, so that a package can be built again with the same bytes.
std::string page_date() {
  std::time_t seconds = std::time(nullptr);
  if (const char* const epoch = std::getenv("SOURCE_DATE_EPOCH")) {
    const std::string_view text(epoch);
    std::int64_t given = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), given);
    if (error == std::errc() && end == text.data() + text.size()) seconds = static_cast<std::time_t>(given);
  }
  std::tm day{};
  gmtime_r(&seconds, &day);
  char date[32];
  return std::string(date, std::strftime(date, sizeof date, "%Y-%m-%d", &day));
}

void print_help(CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  std::string name = app.get_name();
  for (const std::string& word : words) {
    command = command->get_subcommand(word);
    name += " " + word;
  }
  // Not command->help: of the app, that is the help of the command that runs.
  std::cout << app.get_formatter()->make_help(command, name, CLI::AppFormatMode::Normal);
}

}  // namespace

void add_reference_commands(CLI::App& app) {
  CLI::App* help = app.add_subcommand(kHelpCommand, "Show the help of a command");
  const auto words = std::make_shared<std::vector<std::string>>();
  help->add_option("COMMAND", *words, "Words of the command, such as synth surface")->type_name("COMMAND");
  help->callback([&app, words] { print_help(app, *words); });

  CLI::App* manual = app.add_subcommand("manual", "Print the manual page, for man -l -");
  manual->callback([&app] { std::cout << print_man_page(command_tree(app), LACUNA_VERSION, page_date()); });

  CLI::App* completion = app.add_subcommand("completion", "Print the completion of commands for a shell");
  const auto print = std::make_shared<PrintCompletion>(nullptr);
  add_choice(*completion, "SHELL", kShells, *print, "The shell to print it for")->required();
  completion->callback([&app, print] { std::cout << (*print)(command_tree(app)); });
}

}  // namespace lacuna::tools
