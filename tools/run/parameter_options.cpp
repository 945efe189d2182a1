// SPDX-License-Identifier: Apache-2.0
#include "tools/run/parameter_options.hpp"

#include "engine/run/error.hpp"
#include "tools/run/config_files.hpp"

#include <algorithm>
#include <array>
#include <variant>

namespace lacuna::tools {
using namespace io;

namespace {

// The parameters that people use, which --help shows. --help-all shows the others, too.
constexpr std::array<std::string_view, 11> kCommon = {"min_hole", "k",         "min_confidence", "holes_only",
                                                      "bounds",   "where",     "points",         "gpkg",
                                                      "report",   "workspace", "memory_limit"};

struct TypeName {
  std::string operator()(const std::int64_t*) const { return "N"; }
  std::string operator()(const double*) const { return "X"; }
  std::string operator()(const bool*) const { return ""; }
  std::string operator()(const std::string*) const { return "TEXT"; }
  std::string operator()(const std::uint64_t*) const { return "SIZE"; }
  std::string operator()(const std::vector<double>*) const { return "X,X..."; }
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

ParameterOptions::ParameterOptions(const Command& command, ParameterScope scope) {
  const bool is_run = scope == ParameterScope::kRun;
  if (is_run)
    command
        .add_option(
            "--config", config_file_,
            "Config file (TOML), or the name of one that is installed; options of the command line override "
            "it")
        .type("CONFIG");
  FilesConfig defaults;
  for (const Parameter& parameter : parameters(defaults)) {
    Given& given = given_.emplace_back();
    if (parameter.is_constant || (!is_run && parameter.changes != Changes::kProcess)) continue;
    const bool is_flag = std::holds_alternative<bool*>(parameter.value);
    const std::string help(parameter.help);
    const Option option =
        is_flag ? command.add_flag(parameter.option(), given.text, help)
                : command.add_option(parameter.option(), given.text,
                                     help + " Allowed: " + std::string(parameter.allowed) + ".");
    option.type(type_name(parameter)).section(std::string(parameter.section));
    if (std::ranges::find(kCommon, parameter.key) == kCommon.end()) option.rare();
    if (parameter.key == "leave_out" || parameter.key == "classes") {
      option.joined_by_comma();  // one box, or one file, each
    } else {
      option.once();
    }
    if (!is_flag) option.show_default(parameter.print());
    given.option = option;
  }
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
      std::string text = given_[i].text;
      if (all[i].key == "columns") std::ranges::replace(text, ',', ' ');
      all[i].set(text);
    } catch (const Error& error) {
      throw WrongOption(all[i].option(), error.what());
    }
  }
  try {
    check_config(config);
  } catch (const Error& error) {
    if (file.empty()) throw WrongOption(std::string(error.what()));
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

}  // namespace lacuna::tools
