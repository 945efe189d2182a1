// SPDX-License-Identifier: Apache-2.0
#include "tools/commands/workspace_commands.hpp"

#include "engine/parts/kept_files.hpp"
#include "engine/parts/parts.hpp"
#include "engine/run/disk_space.hpp"
#include "engine/run/error.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/measures_text.hpp"
#include "tools/console/visible_text.hpp"
#include "tools/run/folders.hpp"

#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <regex>

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

namespace lacuna::tools {
namespace {

namespace fs = std::filesystem;

KeptState kept_state(const fs::path& folder) {
  const std::optional<KeptState> state = state_of(folder);
  if (!state)
    throw Error(folder.string() + ": not the workspace of a run; allowed: the folder of --workspace");
  return *state;
}

// Returns "  input: a.ply, 12 bytes, written 2026-11-27 20:15" of a line with nanoseconds and a sample, and
// nothing of a parameter.
std::string print_input(const std::string& line) {
  static const std::regex file("(input: .*), written at ([0-9]{1,10})[0-9]{9} ns, .*");
  std::smatch parts;
  if (!std::regex_match(line, parts, file)) return "";
  const std::time_t seconds = std::stoll(parts[2]);
  return fmt::format("  {}, written {:%Y-%m-%d %H:%M}\n", visible(parts[1].str()), fmt::localtime(seconds));
}

void print_status(const fs::path& folder) {
  const KeptState state = kept_state(folder);
  std::cout << visible(folder.string()) << ": " << print_size(state.bytes) << "\n";
  for (const std::string& line : state.made_from) {
    if (line.starts_with("lacuna ")) std::cout << "  " << line << "\n";
    if (line.starts_with("input: ")) std::cout << print_input(line);
  }
  for (const LevelState& level : state.levels) {
    std::cout << "  level " << level.number << ": ";
    if (level.tiles == 0) {
      std::cout << "its points are not stored yet\n";
    } else {
      std::cout << print_count(level.points) << " points, " << level.evaluated << " of " << level.tiles
                << " tiles evaluated, " << level.tiles - level.evaluated << " left"
                << (level.has_loops ? ", loops found" : "") << "\n";
    }
  }
  if (state.damaged > 0) std::cout << "  " << state.damaged << " damaged parts are made again\n";
  std::cout << "The same command goes on from here; lacuna finish does, too.\n";
}

void clean(const fs::path& folder) {
  const KeptState state = kept_state(folder);
  const FolderLock alone(folder);
  for (const fs::path& file : kept_files(folder)) remove_kept(file);
  remove_leftovers(folder, kScratchPrefix);
  const bool has_others = ::rmdir(folder.c_str()) != 0 && !fs::is_empty(folder);  // of a link, it stays
  std::cout << "removed: " << print_size(state.bytes) << " of " << visible(folder.string())
            << (has_others ? ", where other files stay" : "") << "\n";
}

template <class Run>
void add_command(const Command& program, const std::string& name, const std::string& help, Run run) {
  const Command command = program.add_command(name, help);
  const auto folder = std::make_shared<fs::path>();
  command.add_option("WORKSPACE", *folder, "Folder that lacuna detect --workspace has kept")
      .required()
      .type("DIR");
  command.runs([folder, run] { run(*folder); });
}

}  // namespace

std::string print_state(const KeptState& state) {
  std::string text;
  for (const LevelState& level : state.levels) {
    if (level.tiles == 0) continue;
    text += (text.empty() ? "level " : "; level ") + std::to_string(level.number) + ": " +
            std::to_string(level.evaluated) + " of " + std::to_string(level.tiles) + " tiles evaluated";
  }
  return text.empty() ? "no level is stored yet" : text;
}

void add_status_command(const Command& program) {
  add_command(program, "status", "Say what a workspace has of a run", print_status);
}

void add_clean_command(const Command& program) {
  add_command(program, "clean", "Remove the files of a workspace, and the folder if it is empty then", clean);
}

}  // namespace lacuna::tools
