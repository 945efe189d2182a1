// SPDX-License-Identifier: Apache-2.0
#include "engine/level_steps.hpp"
#include "engine/parts/kept_run.hpp"
#include "engine/parts/parts.hpp"
#include "engine/run/error.hpp"
#include "engine/run/machine.hpp"
#include "engine/steps.hpp"
#include "io/read/scan/scan_files.hpp"
#include "io/read/scan/scan_pass.hpp"
#include "tools/commands/commands.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/input_files.hpp"
#include "tools/run/run_program.hpp"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

namespace lacuna::tools {
using namespace io;

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
void add_command(CLI::App& program, const std::string& name, const std::string& help, Run run) {
  CLI::App& command = *program.add_subcommand(name, help);
  const auto folder = std::make_shared<fs::path>();
  command.add_option("WORKSPACE", *folder, "Folder that lacuna detect --workspace has kept")
      ->required()
      ->type_name("DIR");
  command.callback([folder, run] { run(*folder); });
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

void add_status_command(CLI::App& program) {
  add_command(program, "status", "Say what a workspace has of a run", print_status);
}

void add_clean_command(CLI::App& program) {
  add_command(program, "clean", "Remove the files of a workspace, and the folder if it is empty then", clean);
}

namespace {

// Returns whole minutes that a task takes at most. The bound is a whole run of one thread on its points, of a
// rough scan (docs/usage.md, "Memory and disk").
std::uint64_t minutes_of(const Step& step) {
  constexpr std::uint64_t kPointsAMinute = 3'000'000;  // 20 microseconds a point
  return 2 + step.points / step.tasks / kPointsAMinute;
}

struct PlanArguments {
  explicit PlanArguments(CLI::App& command) : parameters(command, parameters_of_run()) {}

  std::vector<fs::path> scans;
  std::size_t tasks = 0;
  bool tsv = false;
  ParameterOptions parameters;
};

void print_plan(const PlanArguments& arguments, const std::vector<Step>& steps, std::uint64_t memory) {
  std::vector<std::vector<std::string>> rows = {{"step", "tasks", "points", "memory of a task", "minutes"}};
  const auto add = [&](const std::string& name, std::size_t tasks, std::uint64_t points,
                       std::uint64_t minutes) {
    if (arguments.tsv) {
      std::cout << name << "\t" << tasks << "\t" << (memory >> 20) << "\t" << minutes << "\n";
    } else {
      rows.push_back(
          {name, std::to_string(tasks), print_count(points), print_size(memory), std::to_string(minutes)});
    }
  };
  std::uint64_t all = 0;
  for (const Step& step : steps) {
    add(step.name(), step.tasks, step.points, minutes_of(step));
    all += step.rule->name == kEvaluate ? step.points : 0;
  }
  // All tiles are read again, and their loops found; the levels that are no steps are made.
  add("finish", 1, all, minutes_of({.points = all}));
  if (!arguments.tsv) std::cout << print_table(rows);
}

void run_plan(const PlanArguments& arguments) {
  FilesConfig config = arguments.parameters.start();
  const fs::path workspace = config.run.workspace;
  if (workspace.empty()) throw WrongOption("--workspace is required");
  require_outside_results(workspace, "", "--workspace");
  const ScanFiles scan = open_inputs(expand_inputs(arguments.scans, config), config);
  const std::vector<std::uint64_t> rows = estimated_rows(scan);
  const std::uint64_t points = std::accumulate(rows.begin(), rows.end(), std::uint64_t{0});
  // Runs without a limit take 120 to 350 bytes a point at most (README); with one, the rest is on disk.
  constexpr std::uint64_t kBytesOfPoint = 256, kLeast = 256 << 20, kMost = std::uint64_t{4} << 30;
  if (config.run.memory_limit == 0)
    config.run.memory_limit = std::clamp(points * kBytesOfPoint, kLeast, kMost);
  config.run.note = print_config(config);
  const KeptFolder folder(workspace);
  ScanPass pass(scan);
  print_plan(arguments, plan(pass, config, arguments.tasks, points), config.run.memory_limit);
}

struct WorkArguments {
  explicit WorkArguments(CLI::App& command) : run(command, parameters_of_process()) {}

  fs::path workspace;
  std::string step;
  std::size_t task = 0;
  RunArguments run;
};

void run_work(const WorkArguments& arguments) {
  const KeptRun stored = read_run(arguments.workspace);
  FilesConfig config = arguments.run.start(config_of(stored, arguments.workspace));
  const std::optional<Step> step = step_of_name(arguments.step, arguments.workspace);
  if (!step) throw WrongOption("--step", "allowed: a step of lacuna plan, such as evaluate-0");
  if (arguments.task >= step->tasks)
    throw WrongOption("--task", "allowed: 0 to " + std::to_string(step->tasks - 1));
  const ScanFiles scan(inputs_of(stored.names), config.input, read_options(config).memory);
  watch_workspace(arguments.workspace);
  const fs::path parent = config.run.scratch.empty() ? arguments.workspace : fs::path(config.run.scratch);
  const ScratchFolder scratch(parent);
  const std::unique_ptr<Progress> progress = arguments.run.show_progress({});
  ScanPass pass(scan);
  const bool exists = do_task(pass, config, *step, arguments.task, scratch.path(), *progress);
  if (!fs::exists(arguments.workspace / kRunPart))
    throw Error(arguments.workspace.string() +
                ": its run was removed meanwhile; lacuna clean removes what this task has left");
  if (!arguments.run.quiet)
    std::cout << arguments.step << ", task " << arguments.task << (exists ? ": done\n" : ": nothing to do\n");
}

struct FinishArguments {
  explicit FinishArguments(CLI::App& command) : run(command, parameters_of_process()) {}

  fs::path workspace;
  ResultArguments run;
};

void run_finish(const FinishArguments& arguments) {
  const KeptRun stored = read_run(arguments.workspace);
  FilesConfig config = arguments.run.start(config_of(stored, arguments.workspace));
  config.run.note = stored.note;
  detect_to(inputs_of(stored.names), config, arguments.run);
}

void add_workspace(CLI::App& command, fs::path& workspace) {
  command.add_option("WORKSPACE", workspace, "Folder of lacuna plan, or of lacuna detect --workspace")
      ->required()
      ->type_name("DIR");
}

}  // namespace

void add_plan_command(CLI::App& program) {
  CLI::App& command = *program.add_subcommand("plan", "Prepare a run that several processes share");
  const auto arguments = std::make_shared<PlanArguments>(command);
  add_scans(command, arguments->scans)->required();
  command.add_option("--tasks", arguments->tasks, "Tasks of each step that is shared")
      ->required()
      ->check(whole_number(1, kMostTasks))
      ->type_name("N");
  command.add_flag("--tsv", arguments->tsv,
                   "For scripts, a line for each step: name, tasks, MiB and minutes of a task");
  command.callback([arguments] { run_plan(*arguments); });
}

void add_work_command(CLI::App& program) {
  CLI::App& command = *program.add_subcommand("work", "Do one task of a step that lacuna plan names");
  const auto arguments = std::make_shared<WorkArguments>(command);
  add_workspace(command, arguments->workspace);
  command.add_option("--step", arguments->step, "Name of the step, such as evaluate-0")
      ->required()
      ->type_name("STEP");
  command.add_option("--task", arguments->task, "Number of the task, from 0 on")
      ->check(whole_number())
      ->type_name("I");
  command.callback([arguments] { run_work(*arguments); });
}

void add_finish_command(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("finish", "Do what a shared run still lacks, and write its results");
  const auto arguments = std::make_shared<FinishArguments>(command);
  add_workspace(command, arguments->workspace);
  command.get_option("--out")->required();
  command.callback([arguments] { run_finish(*arguments); });
}

}  // namespace lacuna::tools
