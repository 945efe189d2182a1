// SPDX-License-Identifier: Apache-2.0
#include "tools/parameter_options.hpp"

#include "engine/run/error.hpp"
#include "tools/config_files.hpp"

#include <algorithm>
#include <filesystem>
#include <variant>

#include <CLI/CLI.hpp>

namespace lacuna::tools {
using namespace io;

namespace {

struct TypeName {
  std::string operator()(const std::int64_t*) const { return "N"; }
  std::string operator()(const double*) const { return "X"; }
  std::string operator()(const bool*) const { return ""; }
  std::string operator()(const std::string*) const { return "TEXT"; }
  std::string operator()(const std::uint64_t*) const { return "SIZE"; }
  std::string operator()(const std::vector<double>*) const { return "X,X..."; }
  std::string operator()(const std::vector<std::int64_t>*) const { return "N,N..."; }
  std::string operator()(const NamedValue& value) const {
    std::string names;
    for (const std::string_view name : value.names) names += (names.empty() ? "" : "|") + std::string(name);
    return names;
  }
};

std::string type_name(const Parameter& parameter) {
  return parameter.key == "workspace" || parameter.key == "scratch" ? "DIR"
                                                                    : std::visit(TypeName{}, parameter.value);
}

}  // namespace

ParameterOptions::ParameterOptions(CLI::App& command) {
  command
      .add_option(
          "--config", config_file_,
          "Config file (TOML), or the name of one that is installed; options of the command line override it")
      ->type_name("CONFIG");
  FilesConfig defaults;
  for (const Parameter& parameter : parameters(defaults)) {
    Given& given = given_.emplace_back();
    if (parameter.is_constant) continue;
    const bool is_flag = std::holds_alternative<bool*>(parameter.value);
    CLI::Option* option = is_flag ? command.add_flag(parameter.option(), given.text)
                                  : command.add_option(parameter.option(), given.text);
    option->description(std::string(parameter.help) +
                        (is_flag ? "" : " Allowed: " + std::string(parameter.allowed) + "."));
    option->group(std::string(parameter.section));
    option->type_name(type_name(parameter));
    option->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    if (parameter.key == "leave_out")  // one box each
      option->delimiter(',')->multi_option_policy(CLI::MultiOptionPolicy::Join);
    if (!is_flag) option->default_str(parameter.print());
    given.option = option;
  }
}

bool ParameterOptions::Given::is_given() const {
  return option != nullptr && option->count() > 0;
}

std::string ParameterOptions::read_file(FilesConfig& config, std::vector<std::string>& keys) const {
  if (config_file_.empty()) return "";
  try {
    const std::string file = find_config(config_file_).string();
    keys = read_config(file, config);
    return file;
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

EffectiveConfig ParameterOptions::read(FilesConfig config) const {
  std::vector<std::string> keys_in_file;
  const std::string file = read_file(config, keys_in_file);
  const std::vector<Parameter> all = parameters(config);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!given_[i].is_given()) continue;
    try {
      all[i].set(given_[i].text);
    } catch (const Error& error) {
      throw CLI::ValidationError(all[i].option(), error.what());
    }
  }
  try {
    check_config(config);
  } catch (const Error& error) {
    if (file.empty()) throw CLI::ValidationError(error.what());
    throw UsageError(file + " with the command line: " + error.what());
  }
  return {config, idle_warnings(config, keys_in_file)};
}

std::vector<std::string> ParameterOptions::idle_warnings(FilesConfig config,
                                                         const std::vector<std::string>& keys_in_file) const {
  FilesConfig defaults;
  const std::vector<Parameter> all = parameters(config), unchanged = parameters(defaults);
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].missing.empty()) continue;
    const bool in_file =
        std::find(keys_in_file.begin(), keys_in_file.end(), all[i].key) != keys_in_file.end();
    const std::string effect = " changes nothing without " + std::string(all[i].missing);
    if (given_[i].is_given()) {
      warnings.push_back(all[i].option() + effect);
    } else if (in_file && all[i].print() != unchanged[i].print()) {
      warnings.push_back(config_file_ + ": " + std::string(all[i].key) + effect);
    }
  }
  return warnings;
}

std::vector<std::string> join_columns(std::vector<std::string> arguments) {
  std::vector<std::string> joined;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--") {
      joined.insert(joined.end(), arguments.begin() + static_cast<std::ptrdiff_t>(i), arguments.end());
      break;
    }
    const auto is_name = [&](std::size_t at) {
      return at < arguments.size() && !arguments[at].starts_with('-') &&
             !std::filesystem::exists(arguments[at]);
    };
    if (arguments[i] != "--columns" || !is_name(i + 1)) {
      joined.push_back(arguments[i]);
      continue;
    }
    std::string names = arguments[++i];
    std::replace(names.begin(), names.end(), ',', ' ');
    if (names.find(' ') == std::string::npos) {
      while (is_name(i + 1)) names += " " + arguments[++i];
    }
    joined.push_back("--columns=" + names);
  }
  return joined;
}

}  // namespace lacuna::tools
