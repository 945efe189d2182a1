// SPDX-License-Identifier: Apache-2.0
#include "tools/program.hpp"

#include "engine/run/error.hpp"
#include "engine/run/words.hpp"
#include "engine/store/temporary_folder.hpp"
#include "tools/compare_command.hpp"
#include "tools/detect_command.hpp"
#include "tools/evaluate_command.hpp"
#include "tools/find_stations_command.hpp"
#include "tools/info_command.hpp"
#include "tools/log_file.hpp"
#include "tools/parameter_options.hpp"
#include "tools/reference_commands.hpp"
#include "tools/render_command.hpp"
#include "tools/report_command.hpp"
#include "tools/signals.hpp"
#include "tools/stations_command.hpp"
#include "tools/synth_command.hpp"
#include "tools/terminal.hpp"
#include "tools/unit_commands.hpp"
#include "tools/update_command.hpp"
#include "tools/visible_text.hpp"
#include "tools/workspace_commands.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace lacuna::tools {
namespace {

enum ExitCode { kDone = 0, kFailed = 1, kWrongUsage = 2 };

int fail(const std::string& reason, ExitCode code) {
  wait_if_interrupted();  // the signal says how the program ends
  print_error(reason + complete_results());
  return code;
}

// A full disk behind stdout is a failure like any other. Where a reader has closed the pipe, as `head` does,
// it has all that it wants.
int flush_output() {
  std::cout.flush();
  if (std::cout || output_failure() == EPIPE) return kDone;
  return fail("cannot write to standard output: " + std::string(std::strerror(output_failure())), kFailed);
}

void warn_of_remaining_folders() {
  for (const auto& [folder, reason] : remaining_folders())
    spdlog::warn("{}: is not needed any more, but cannot be removed: {}", folder.string(), reason);
}

const CLI::App* find_command(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->check_name(name)) return command;
  }
  return nullptr;
}

// "--k=3" is the option --k. Without it a misspelt option is an argument that was not expected.
void check_option_names(const CLI::App& command, std::span<const std::string> arguments) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const std::string& argument : arguments) {
    if (argument == "--") return;
    const std::string name = argument.substr(0, argument.find('='));
    if (!name.starts_with("--") || std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw CLI::ParseError("unknown option " + name + suggestion(name, {names.begin(), names.end()}),
                          CLI::ExitCodes::ExtrasError);
  }
}

// Without it, a misspelt command is reported as a missing one.
void check_names(const CLI::App& app, std::span<const std::string> arguments) {
  const std::vector<const CLI::App*> commands = app.get_subcommands({});
  if (commands.empty()) return check_option_names(app, arguments);
  if (arguments.empty() || arguments.front().starts_with('-')) return;
  const std::string& word = arguments.front();
  if (word == kHelpCommand && app.get_parent() == nullptr) return check_names(app, arguments.subspan(1));
  if (const CLI::App* const command = find_command(app, word))
    return check_names(*command, arguments.subspan(1));
  std::vector<std::string_view> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  throw CLI::ParseError(
      "unknown command \"" + word + "\"" + suggestion(word, names) + "; allowed: " + listed(names),
      CLI::ExitCodes::ExtrasError);
}

int run_command(CLI::App& app, const std::vector<std::string>& arguments) {
  check_names(app, arguments);
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  warn_of_remaining_folders();
  return flush_output();
}

std::string usage_hint(const CLI::App& app, const std::vector<std::string>& arguments) {
  std::string words = "lacuna";
  const CLI::App* at = &app;
  for (const std::string& argument : arguments) {
    at = find_command(*at, argument);
    if (at == nullptr) break;
    words += " " + argument;
  }
  return " (see " + words + " --help)";
}

// The options that help, where the command has them.
std::string out_of_memory(const CLI::App& app) {
  std::string text = "out of memory";
  for (const CLI::App* command : app.get_subcommands()) {
    if (command->get_option_no_throw("--memory-limit") != nullptr)
      text += "; a lower --memory-limit or smaller --tile-points may help";
  }
  return text;
}

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

// Where one is closed, the next file to be opened would take its number, and messages would go into that
// file. Writing to them fails, as it does to a closed one.
void open_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    if (open("/dev/null", O_RDONLY) != descriptor) {
      throw Error("/dev/null: cannot be opened: " + std::string(std::strerror(errno)));
    }
  }
}

void prepare_process() {
  open_standard_descriptors();
  // A closed pipe and a file over the size limit are errors to report, after the workspace is removed.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  start_log();
  show_output_visibly(stdout);
  // A library may throw where nothing can catch it, such as for a thread that cannot be started.
  std::set_terminate([] {
    print_error("the system has no more memory or threads for this process");
    std::_Exit(kFailed);
  });
  handle_signals();
}

}  // namespace

int run(int argc, char** argv) {
  CLI::App app("Lacuna finds holes in scanned surfaces, also in scans larger than memory.", "lacuna");
  app.set_version_flag("-V,--version", "lacuna " LACUNA_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  add_detect_command(app);
  add_evaluate_command(app);
  add_compare_command(app);
  add_info_command(app);
  add_status_command(app);
  add_clean_command(app);
  add_plan_command(app);
  add_work_command(app);
  add_finish_command(app);
  add_update_command(app);
  add_report_command(app);
  add_find_stations_command(app);
  add_stations_command(app);
  add_render_command(app);
  add_synth_command(app);
  add_reference_commands(app);

  const std::vector<std::string> arguments = join_columns({argv + 1, argv + argc});
  try {
    prepare_process();
    remember_command_line("lacuna " LACUNA_VERSION, argc, argv);
    return run_command(app, arguments);
  } catch (const CLI::Success& shown) {  // --help, --version
    app.exit(shown, std::cout, std::cerr);
    return flush_output();
  } catch (const CLI::Error& error) {
    return fail(one_line(error.what()) + usage_hint(app, arguments), kWrongUsage);
  } catch (const UsageError& error) {
    return fail(one_line(error.what()), kWrongUsage);
  } catch (const Error& error) {
    return fail(one_line(error.what()), kFailed);
  } catch (const std::bad_alloc&) {
    return fail(out_of_memory(app), kFailed);
  } catch (const std::exception& error) {  // of the file system, mostly
    return fail(one_line(error.what()), kFailed);
  }
}

}  // namespace lacuna::tools
