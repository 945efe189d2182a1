#include "tools/program.hpp"

#include "engine/run/error.hpp"
#include "tools/detect_command.hpp"
#include "tools/evaluate_command.hpp"
#include "tools/info_command.hpp"
#include "tools/parameter_options.hpp"
#include "tools/reference_commands.hpp"
#include "tools/signals.hpp"
#include "tools/synth_command.hpp"
#include "tools/terminal.hpp"
#include "tools/visible_text.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
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
#include <unistd.h>

namespace lacuna {
namespace {

enum ExitCode { kDone = 0, kFailed = 1, kWrongUsage = 2 };

int fail(const std::string& reason, ExitCode code) {
  wait_if_interrupted();  // the signal tells how the program ends
  print_error(reason);
  return code;
}

// A full disk or a closed pipe behind stdout is a failure like any other.
int flush_output() {
  std::cout.flush();
  if (std::cout) return kDone;
  return fail("cannot write to standard output", kFailed);
}

// Without it a misspelt command is told as a missing one.
void check_command_names(const CLI::App& app, std::span<const std::string> arguments) {
  const std::vector<const CLI::App*> commands = app.get_subcommands({});
  if (commands.empty() || arguments.empty() || arguments.front().starts_with('-')) return;
  std::string known;
  for (const CLI::App* command : commands) {
    if (command->check_name(arguments.front())) return check_command_names(*command, arguments.subspan(1));
    known += (known.empty() ? "" : ", ") + command->get_name();
  }
  throw CLI::ParseError("unknown command \"" + arguments.front() + "\"; allowed: " + known,
                        CLI::ExitCodes::ExtrasError);
}

int run_command(CLI::App& app, const std::vector<std::string>& arguments) {
  check_command_names(app, arguments);
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  return flush_output();
}

std::string usage_hint(const CLI::App& app) {
  std::string command = "lacuna";
  for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    command += " " + at->get_name();
  }
  return " (see " + command + " --help)";
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
  handle_signals();
}

}  // namespace

int run(int argc, char** argv) {
  CLI::App app("Lacuna finds every hole in a scan that is larger than memory.", "lacuna");
  app.set_version_flag("-V,--version", "lacuna " LACUNA_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  add_detect_command(app);
  add_evaluate_command(app);
  add_info_command(app);
  add_synth_command(app);
  add_reference_commands(app);

  try {
    prepare_process();
    return run_command(app, join_columns({argv + 1, argv + argc}));
  } catch (const CLI::Success& shown) {  // --help, --version
    app.exit(shown, std::cout, std::cerr);
    return flush_output();
  } catch (const CLI::Error& error) {
    return fail(one_line(error.what()) + usage_hint(app), kWrongUsage);
  } catch (const Error& error) {
    return fail(one_line(error.what()), kFailed);
  } catch (const std::bad_alloc&) {
    return fail("out of memory; a lower --memory-limit or smaller --tile-points may help", kFailed);
  } catch (const std::exception& error) {  // of the file system, mostly
    return fail(one_line(error.what()), kFailed);
  }
}

}  // namespace lacuna
