// SPDX-License-Identifier: Apache-2.0
#include "tools/console/command_line.hpp"

#include "engine/run/words.hpp"
#include "io/read/files/number.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <limits>

#include <CLI/CLI.hpp>

namespace lacuna::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kGeneral = "Options";

std::string section_of(const CLI::Option& option) {
  const std::string& group = option.get_group();
  return group.starts_with(kRare) ? group.substr(kRare.size()) : group;
}

using Options = std::vector<const CLI::Option*>;
using Apps = std::vector<const CLI::App*>;

template <class Condition>
Options chosen(const Options& options, Condition is_chosen) {
  Options chosen;
  std::ranges::copy_if(options, std::back_inserter(chosen), is_chosen);
  return chosen;
}

// --help has the options that people use, in one list; --help-all has every option, by section.
class Help final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    if (mode == CLI::AppFormatMode::Sub) return make_expanded(app);
    const Options all = options_of(*app);
    return make_description(app) + make_usage(app, name) + make_positionals(app) +
           (mode == CLI::AppFormatMode::All ? by_section(all) : common(all)) + make_subcommands(app, mode);
  }

  // A command within --help-all of the program.
  std::string make_expanded(const CLI::App* app) const override {
    const Options own = chosen(options_of(*app), [&](const CLI::Option* option) {
      return option != app->get_help_ptr() && option != app->get_help_all_ptr();
    });
    return "\n" + app->get_parent()->get_name() + " " + app->get_name() + ":\n" + make_description(app) +
           make_positionals(app) + by_section(own) + make_subcommands(app, CLI::AppFormatMode::Sub);
  }

  // The name of an argument says what it takes.
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string text = Formatter::make_option_opts(option), type = " " + option->get_type_name();
    return option->get_positional() && text.starts_with(type) ? text.substr(type.size()) : text;
  }

 private:
  static Options options_of(const CLI::App& app) {
    return app.get_options(
        [](const CLI::Option* option) { return option->nonpositional() && !option->get_group().empty(); });
  }

  std::string common(const Options& all) const {
    Options common =
        chosen(all, [](const CLI::Option* option) { return !option->get_group().starts_with(kRare); });
    std::ranges::stable_partition(common,
                                  [](const CLI::Option* option) { return option->get_group() == kGeneral; });
    std::string text = make_group(std::string(kGeneral), false, common);
    if (common.size() < all.size())
      text += "\n--help-all shows " + std::to_string(all.size() - common.size()) + " more options.\n";
    return text;
  }

  std::string by_section(const Options& all) const {
    std::vector<std::string> sections;
    for (const CLI::Option* option : all) {
      if (std::ranges::find(sections, section_of(*option)) == sections.end())
        sections.push_back(section_of(*option));
    }
    std::string text;
    for (const std::string& section : sections) {
      text +=
          make_group(section, false,
                     chosen(all, [&](const CLI::Option* option) { return section_of(*option) == section; }));
    }
    return text;
  }
};

const CLI::App* find_command(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->check_name(name)) return command;
  }
  return nullptr;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

// Options without a group are there to be refused.
bool offers(const CLI::App& app, const std::string& name) {
  const CLI::Option* const option = app.get_option_no_throw(name);
  return option != nullptr && !option->get_group().empty();
}

// Other programs name their input and output by options such as -i and --output.
std::string option_hint(const CLI::App& command, const std::string& name) {
  if (name == "-i" || name == "--input") return "; the names of inputs need no option";
  for (const CLI::App* parent = command.get_parent(); parent != nullptr; parent = parent->get_parent()) {
    const std::string path = parent->get_name();
    if (offers(*parent, name)) return "; it has no command before it: " + path + " " + name;
    for (const CLI::App* other : parent->get_subcommands({})) {
      if (offers(*other, name)) return "; " + path + " " + other->get_name() + " has it";
    }
  }
  const bool has_out = command.get_option_no_throw("--out") != nullptr;
  const bool is_of_file = command.get_parent() != nullptr && !has_out;
  if (is_of_file && (name == "-o" || name == "--output" || name == "--out"))
    return "; the names of files need no option";
  const std::vector<std::string> names = option_names(command);
  const bool chooses_points = command.get_option_no_throw("--where") != nullptr;
  if (chooses_points && name.starts_with("--class"))
    return suggestion(name, {names.begin(), names.end()}) +
           "; --where 'Classification == 2' chooses points by their class";
  if (chooses_points && name.starts_with("--pose"))
    return "; a list of files has poses: @LIST with lines such as scan2.ply pose=scan2.xf";
  if (name.starts_with("--")) return suggestion(name, {names.begin(), names.end()});
  for (const CLI::Option* option : command.get_options()) {
    const bool is_parameter = section_of(*option) != kGeneral;
    for (const std::string& other : option->get_lnames()) {
      if (other.front() == name[1] && (!is_parameter || other.size() == 1))
        return suggestion("--" + other, {"--" + other});
    }
  }
  return "";
}

// "--k=3" is the option --k. Without this step, a misspelt option is an argument that was not expected.
void check_option_names(const CLI::App& command, std::span<const std::string> arguments) {
  const std::vector<std::string> names = option_names(command);
  for (const std::string& argument : arguments) {
    if (argument == "--") return;
    std::error_code error;
    if (argument.size() > 2 && argument[0] == '-' && argument[1] != '-' && fs::exists(argument, error))
      throw WrongOption(argument + ": a file whose name begins with - comes after -- or as ./" + argument);
    const std::string name = argument.substr(0, argument.find('='));
    const bool is_short = name.size() == 2 && name[0] == '-' && std::isalpha(name[1]) != 0;
    const bool is_option = name.starts_with("--") || is_short;
    if (is_option && std::ranges::find(names, name) == names.end())
      throw WrongOption("unknown option " + name + option_hint(command, name));
  }
}

// Without this check, CLI11 reports a misspelt command as a missing one.
void check_names(const CLI::App& app, std::span<const std::string> arguments) {
  const std::vector<const CLI::App*> commands = app.get_subcommands({});
  if (commands.empty()) return check_option_names(app, arguments);
  if (arguments.empty()) return;
  if (arguments.front().starts_with('-')) return check_option_names(app, arguments.first(1));
  const std::string& word = arguments.front();
  if (const CLI::App* const command = find_command(app, word))
    return check_names(*command, arguments.subspan(1));
  std::vector<std::string_view> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  const std::vector<std::string> options = option_names(app);  // "lacuna version"
  const auto option = std::ranges::find(options, "--" + word);
  std::error_code error;
  if (std::filesystem::exists(word, error))
    throw WrongOption(word + ": a file; allowed: a command before it, such as " + app.get_name() + " " +
                      std::string(names.front()) + " " + word);
  throw WrongOption("unknown command \"" + word + "\"" +
                    (option == options.end() ? suggestion(word, names) : suggestion(*option, {*option})) +
                    "; allowed: " + listed(names));
}

std::string usage_hint(const CLI::App& app, const std::vector<std::string>& arguments) {
  std::string words = app.get_name();
  const CLI::App* at = &app;
  for (const std::string& argument : arguments) {
    at = find_command(*at, argument);
    if (at == nullptr) break;
    words += " " + argument;
  }
  return " (see " + words + " --help)";
}

// A check of a value: it names the allowed values if `is_possible` is false.
template <class IsPossible>
CLI::Validator allowing(const std::string& allowed, IsPossible is_possible) {
  const auto check = [allowed, is_possible](const std::string& text) {
    return is_possible(text) ? std::string() : text + " is not possible; allowed: " + allowed;
  };
  return CLI::Validator(check, "");
}

}  // namespace

CLI::Validator whole_number(std::size_t least, std::size_t most) {
  const bool is_bounded = most < std::numeric_limits<std::size_t>::max();
  const std::string range =
      is_bounded ? "a whole number from " + std::to_string(least) + " to " + std::to_string(most)
                 : "a whole number, " + std::to_string(least) + " or more";
  return allowing(range, [least, most](const std::string& text) {
    std::size_t value = 0;
    return io::parse_number(text, value) && value >= least && value <= most;
  });
}

CLI::Validator real_number() {
  return allowing("a number without a unit, with a decimal point", [](const std::string& text) {
    double value = 0;
    return io::parse_number(text, value);
  });
}

CLI::Validator name_ending_in(const std::string& ending) {
  return allowing("a name that ends in " + ending, [ending](const std::string& text) {
    return CLI::detail::to_lower(fs::path(text).extension().string()) == ending;
  });
}

CLI::Option* add_choice(CLI::App& command, const std::string& name, std::span<const std::string_view> names,
                        const std::function<void(std::size_t)>& choose, const std::string& help) {
  const std::vector<std::string> all(names.begin(), names.end());
  const auto choose_by_name = [all, choose, name](const std::string& text) {
    const auto found = std::ranges::find(all, text);
    if (found == all.end())
      throw WrongOption(name + " = " + text, "is not possible; allowed: " + CLI::detail::join(all, ", "));
    choose(static_cast<std::size_t>(found - all.begin()));
  };
  return command.add_option_function<std::string>(name, choose_by_name, help)
      ->type_name(CLI::detail::join(all, "|"));
}

CommandLine::CommandLine(const std::string& name, const std::string& help, const std::string& version)
    : app_(std::make_unique<CLI::App>(help, name)) {
  app_->formatter(std::make_shared<Help>());
  app_->set_help_flag("-h,--help", "Show the options that are used most, and end");
  app_->set_help_all_flag("--help-all", "Show every option, and end");
  app_->set_version_flag("-V,--version", version, "Show the version, and end");
  app_->require_subcommand(1);
}

CommandLine::~CommandLine() = default;

void CommandLine::run(std::vector<std::string> arguments) {
  if (arguments.empty() || arguments.front() == "help") {
    if (!arguments.empty()) arguments.erase(arguments.begin());
    arguments.push_back("--help");
  }
  try {
    check_names(*app_, arguments);
    app_->parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& shown) {  // --help, --version
    app_->exit(shown, std::cout, std::cerr);
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string text = error.what();
    throw UsageError(text.substr(0, text.find(':')) +
                     (text.find("At Most") != text.npos ? " is given more than once" : " lacks a value") +
                     usage_hint(*app_, arguments));
  } catch (const CLI::ExtrasError& error) {
    const std::string text = error.what();
    throw UsageError("not expected:" + text.substr(text.find(':') + 1) + usage_hint(*app_, arguments));
  } catch (const CLI::Error& error) {
    throw UsageError(error.what() + usage_hint(*app_, arguments));
  } catch (const WrongOption& error) {
    throw UsageError(error.what() + usage_hint(*app_, arguments));
  }
}

}  // namespace lacuna::tools
