// SPDX-License-Identifier: Apache-2.0
#include "tools/run/run_program.hpp"

#include "engine/run/error.hpp"
#include "engine/store/temporary_folder.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"
#include "tools/console/visible_text.hpp"
#include "tools/run/signals.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace lacuna::tools {
namespace {

enum ExitCode { kDone = 0, kFailed = 1, kWrongUsage = 2, kNotDecided = 3 };

int fail(const std::string& reason, ExitCode code) {
  wait_if_interrupted();  // the signal says how the program ends
  print_error(reason + complete_results());
  return code;
}

// Returns the exit code. A full disk behind stdout is a failure like any other. A reader that has closed the
// pipe, as `head` does, has all that it wants, so this is none.
int flush_output() {
  std::cout.flush();
  if (std::cout || output_failure() == EPIPE) return kDone;
  return fail("cannot write to standard output: " + std::string(std::strerror(output_failure())), kFailed);
}

void warn_of_remaining_folders() {
  for (const auto& [folder, reason] : remaining_folders())
    spdlog::warn("{}: is not needed any more, but cannot be removed: {}", folder.string(), reason);
}

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

// If stdin, stdout or stderr is closed, the next file that the program opens would take its number, and
// messages would go into that file. So /dev/null takes the number. It is open for reading alone: writing to
// it fails, as it does for a closed stdout.
void open_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    if (open("/dev/null", O_RDONLY) != descriptor) {
      throw Error("/dev/null: cannot be opened: " + std::string(std::strerror(errno)));
    }
  }
}

void prepare_process(const std::string& name) {
  open_standard_descriptors();
  // These signals would end the process. Ignored, they are errors of writing, which it reports after it has
  // removed its temporary files.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  start_log(name);
  show_output_visibly(stdout);
  // A library may throw where nothing can catch it, such as for a thread that cannot be started.
  std::set_terminate([] {
    print_error("the system has no more memory or threads for this process");
    std::_Exit(kFailed);
  });
  handle_signals();
}

}  // namespace

int run_program(const std::string& name, CommandLine& line, int argc, char** argv) {
  try {
    prepare_process(name);
    line.run({argv + 1, argv + argc});
    warn_of_remaining_folders();
    return flush_output();
  } catch (const AnswerIsNo& no) {
    const int written = flush_output();
    print_line(name + ": " + one_line(no.answer));
    if (written != kDone) return written;
    return no.is_decided ? kFailed : kNotDecided;
  } catch (const UsageError& error) {
    return fail(one_line(error.what()), kWrongUsage);
  } catch (const Error& error) {
    return fail(one_line(error.what()), kFailed);
  } catch (const std::bad_alloc&) {
    const bool can_take_less = line.has_option("--memory-limit");
    return fail(std::string("out of memory") +
                    (can_take_less ? "; a lower --memory-limit or smaller --tile-points may help" : ""),
                kFailed);
  } catch (const std::filesystem::filesystem_error& error) {  // such as a name that is too long
    return fail(one_line(error.path1().string() + ": " + error.code().message()), kFailed);
  } catch (const std::exception& error) {
    return fail(one_line(error.what()), kFailed);
  }
}

}  // namespace lacuna::tools
