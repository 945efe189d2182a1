// SPDX-License-Identifier: Apache-2.0

#include "engine/config/config.hpp"
#include "engine/run/error.hpp"
#include "engine/run/memory.hpp"
#include "engine/run/words.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/terminal.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <link.h>
#include <malloc.h>
#include <sys/mman.h>
#include <tbb/global_control.h>
#include <unistd.h>

namespace lacuna::tools {
using namespace io;

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> config_folders() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const fs::path folder = program.parent_path();
  std::vector<fs::path> folders = {folder.parent_path() / "share/lacuna/configs",
                                   folder / "share/lacuna/configs"};
  if (fs::exists(folder / "CMakeCache.txt", error)) folders.push_back(folder.parent_path() / "configs");
  return folders;
}

[[noreturn]] void fail_unknown(const std::string& name, const std::vector<fs::path>& folders) {
  std::set<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code error;  // a folder that is missing has no config
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
    }
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw Error("--config " + name + ": no file and no installed config has this name" +
              suggestion(name, known) + "; allowed: a TOML file" +
              (known.empty() ? "; no config is installed" : ", or one of these: " + listed(known)));
}

// Returns `given` itself if it names an existing file, or has a slash or the ending .toml. Else returns
// NAME.toml from the first of two folders that has it. The first is share/lacuna/configs of the prefix that
// the program is installed in. The second is the source's configs, for a program in a build folder within.
// Throws `Error`, which lists the names that exist, if neither folder has the file.
fs::path find_config(const std::string& given) {
  std::error_code error;
  const bool is_file = given.find('/') != given.npos || given.ends_with(".toml") || fs::exists(given, error);
  if (is_file) return given;
  const std::vector<fs::path> folders = config_folders();
  for (const fs::path& folder : folders) {
    const fs::path file = folder / (given + ".toml");
    if (fs::exists(file, error)) return file;
  }
  fail_unknown(given, folders);
}

bool is_named(const Parameter& parameter, const std::vector<std::string_view>& names) {
  return std::ranges::any_of(
      names, [&](std::string_view name) { return name == parameter.section || name == parameter.key; });
}

// Takes the value of the same parameter of another config.
struct Take {
  const Parameter::Value& from;

  template <class T>
  void operator()(T* to) const {
    *to = *std::get<T*>(from);
  }
  void operator()(const NamedValue& to) const { *to.value = *std::get<NamedValue>(from).value; }
};

struct TypeName {
  std::string operator()(const std::int64_t*) const { return "N"; }
  std::string operator()(const double*) const { return "X"; }
  std::string operator()(const bool*) const { return ""; }
  std::string operator()(const std::string*) const { return "TEXT"; }
  std::string operator()(const std::uint64_t*) const { return "SIZE"; }
  std::string operator()(const std::vector<double>*) const { return "X,X..."; }
  std::string operator()(const NamedValue&) const { return "NAME"; }
};

// The sections of how holes are looked for are one in the help.
std::string help_section(const Parameter& parameter) {
  constexpr std::array<std::string_view, 4> kSearch = {"scale", "neighbourhood", "normals", "loops"};
  return std::string(std::ranges::count(kSearch, parameter.section) > 0 ? "search" : parameter.section);
}

// Adds an option that says where its parameter is set.
void refuse_option(const Parameter& parameter, CLI::App& command) {
  const std::string reason = "is no option; a file for --config sets it, in its section [" +
                             std::string(parameter.section) + "]: " + std::string(parameter.key) + " = " +
                             parameter.print();
  const auto fail = [option = parameter.option(), reason](const std::string&) {
    throw WrongOption(option, reason);
  };
  command.add_option_function<std::string>(parameter.option(), fail)->expected(0, 1)->group("");
}

std::string type_name(const Parameter& parameter) {
  return parameter.key == "workspace" || parameter.key == "scratch" ? "DIR"
                                                                    : std::visit(TypeName{}, parameter.value);
}

// Shows a default of the config file without its quotes; an empty list has none.
void show_default(CLI::Option& option, const std::string& text) {
  const bool is_quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  if (text != "[]") option.default_str(is_quoted ? text.substr(1, text.size() - 2) : text);
}

constexpr std::uint64_t kMiB = 1 << 20;

// Gives back the tables of symbols that the dynamic linker has read: 20 MiB, since OpenVDB is linked. The
// system reads them again if they are needed.
void release_symbol_tables() {
  const auto release = [](dl_phdr_info* library, std::size_t, void*) {
    const std::uintptr_t page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    for (int i = 0; i < library->dlpi_phnum; ++i) {
      const auto& segment = library->dlpi_phdr[i];
      if (segment.p_type != PT_LOAD || segment.p_flags != PF_R) continue;  // neither code nor data
      const std::uintptr_t begin = (library->dlpi_addr + segment.p_vaddr) / page * page;
      ::madvise(reinterpret_cast<void*>(begin),
                library->dlpi_addr + segment.p_vaddr + segment.p_memsz - begin, MADV_DONTNEED);
    }
    return 0;
  };
  ::dl_iterate_phdr(release, nullptr);
}

// Large arrays come from the system and go back to it; small ones share few arenas. Without this, memory that
// threads free stays with them, and the process grows beyond its limit. If the limit is far, memory is kept
// and used again, because the system has to clear fresh pages. Within 64 MiB, the least limit, the process
// keeps next to no memory.
void set_up_allocator(std::uint64_t limit) {
  ::mallopt(M_MMAP_THRESHOLD, static_cast<int>(std::clamp(limit / 64, kMiB, 32 * kMiB)));
  ::mallopt(M_TRIM_THRESHOLD,
            static_cast<int>(std::clamp((std::max(limit, 64 * kMiB) - 56 * kMiB) / 8, kMiB, 512 * kMiB)));
  // An arena keeps up to several MiB that nobody uses.
  ::mallopt(M_ARENA_MAX, static_cast<int>(std::clamp<std::uint64_t>(limit / (32 * kMiB), 1, 4)));
}

// Sets the allocator up, gives back the memory of the start, and allows more threads than there are cores.
// The library makes no such setting, since it may run in the process of another program. Call it once.
void prepare_process(const RunConfig& config) {
  set_up_allocator(Memory::share(config.memory_limit).limit);
  release_symbol_tables();
  if (config.threads > 0) {
    static const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                             static_cast<std::size_t>(config.threads));
  }
}

}  // namespace

bool ReadParameters::has(const Parameter& parameter) const {
  return is_named(parameter, common) || is_named(parameter, rare);
}

ReadParameters parameters_of_run() {
  return {.common = {"min_hole", "k", "min_confidence", "holes_only", "bounds", "where", "crs", "unit",
                     "points", "gpkg", "stations", "report", "workspace", "memory_limit"},
          .rare = {"scale", "neighbourhood", "normals", "criteria", "coherence", "loops", "spanning",
                   "tangential", "selection", "input", "output", "run"}};
}

ReadParameters parameters_of_check() {
  return {.common = {"area", "report", "bounds", "where", "memory_limit"}, .rare = {"input", "threads"}};
}

ReadParameters parameters_of_info() {
  return {.common = {"min_hole", "bounds", "where", "stations", "memory_limit"},
          .rare = {"resolution", "input", "threads", "tile_points", "scratch"}};
}

ReadParameters parameters_of_process() {
  return {.common = {"memory_limit"}, .rare = {"threads", "scratch"}, .has_config_file = false};
}

bool ParameterOptions::Given::is_given() const {
  return option != nullptr && option->count() > 0;
}

ParameterOptions::ParameterOptions(CLI::App& command, const ReadParameters& read) {
  if (read.has_config_file)
    command
        .add_option(
            "--config", config_file_,
            "Config file (TOML), or the name of one that is installed; options of the command line override "
            "it")
        ->type_name("CONFIG");
  FilesConfig defaults;
  for (const Parameter& parameter : parameters(defaults)) {
    Given& given = given_.emplace_back();
    given.is_read = read.has(parameter);
    if (!given.is_read) continue;
    if (parameter.in_file_only) {
      refuse_option(parameter, command);
      continue;
    }
    const bool is_flag = std::holds_alternative<bool*>(parameter.value);
    const std::string help(parameter.help), group = help_section(parameter);
    given.option = is_flag ? command.add_flag(parameter.option(), given.text, help)
                           : command.add_option(parameter.option(), given.text,
                                                help + " Allowed: " + std::string(parameter.allowed) + ".");
    given.option->type_name(type_name(parameter));
    given.option->group(is_named(parameter, read.common) ? group : std::string(kRare) + group);
    if (parameter.key == "leave_out" || parameter.key == "classes") {  // one box, or one file, each
      given.option->delimiter(',')->multi_option_policy(CLI::MultiOptionPolicy::Join);
    } else {
      given.option->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    }
    if (!is_flag) show_default(*given.option, parameter.print());
  }
}

std::string ParameterOptions::take_file(FilesConfig& config, std::vector<std::string>& keys) const {
  if (config_file_.empty()) return "";
  try {
    const std::string file = find_config(config_file_).string();
    FilesConfig in_file = config;
    keys = read_config(file, in_file);
    const std::vector<Parameter> all = parameters(config), found = parameters(in_file);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (given_[i].is_read) std::visit(Take{found[i].value}, all[i].value);
    }
    return file;
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

EffectiveConfig ParameterOptions::read(FilesConfig config) const {
  std::vector<std::string> keys_in_file;
  const std::string file = take_file(config, keys_in_file);
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

FilesConfig ParameterOptions::start(FilesConfig base) const {
  auto [config, warnings] = read(std::move(base));
  print_warnings(warnings);
  prepare_process(config.run);
  return config;
}

std::vector<std::string> ParameterOptions::idle_warnings(FilesConfig config,
                                                         const std::vector<std::string>& keys_in_file) const {
  FilesConfig defaults;
  const std::vector<Parameter> all = parameters(config), unchanged = parameters(defaults);
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!given_[i].is_read || all[i].missing.empty()) continue;
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

CLI::Option* add_scans(CLI::App& command, std::vector<fs::path>& scans) {
  return command
      .add_option("SCAN", scans,
                  "Scan files, folders of them, or @LIST of names and poses; several are one registered scan")
      ->type_name("SCAN");
}

CLI::Option* add_results_folder(CLI::App& command, fs::path& folder) {
  return command.add_option("DIR", folder, "Folder with the results of lacuna detect")
      ->type_name("DIR")
      ->required();
}

}  // namespace lacuna::tools
