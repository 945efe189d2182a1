// SPDX-License-Identifier: Apache-2.0
#include "tools/run/signals.hpp"

#include "engine/run/error.hpp"
#include "engine/store/temporary_folder.hpp"
#include "io/read/files/input_file.hpp"
#include "tools/console/terminal.hpp"
#include "tools/run/folders.hpp"

#include <atomic>
#include <csignal>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include <pthread.h>
#include <unistd.h>

namespace lacuna::tools {
namespace {

std::atomic<bool> interrupted = false;

struct WatchedResults {
  std::filesystem::path folder, report;
  std::optional<io::FileIdentity> before;  // of the report; results of this run have another
  bool are_complete = false;
};

std::mutex watched_mutex;
std::optional<WatchedResults> watched;
std::filesystem::path watched_workspace;  // empty without one

std::string completeness(const WatchedResults& results) {
  return "; the results in " + results.folder.string() + " are complete";
}

std::string last_line() {
  const std::lock_guard lock(watched_mutex);
  std::string line = program_name() + ": interrupted";
  if (!watched) return line;
  const bool is_complete = watched->are_complete || io::find_identity(watched->report) != watched->before;
  if (is_complete) return line + completeness(*watched);
  line += "; " + watched->folder.string() + " is as it was";
  if (watched_workspace.empty()) return line;
  return line + "; the same command goes on from " + watched_workspace.string();
}

void wait_for_signal(sigset_t signals) {
  int signal = 0;
  sigwait(&signals, &signal);
  interrupted = true;
  clear_progress_now();
  remove_temporary_folders();  // waits while results take their names
  remove_made_folders();
  print_last_line(last_line());
  _exit(128 + signal);
}

}  // namespace

void handle_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    const bool is_ignored = action.sa_handler == SIG_IGN;  // by nohup, or by a shell in the background
    if (!is_ignored) sigaddset(&signals, signal);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  try {
    std::thread(wait_for_signal, signals).detach();
  } catch (const std::system_error& error) {
    throw Error(std::string("cannot start a thread: ") + error.what());
  }
}

void watch_results(const std::filesystem::path& folder, const std::filesystem::path& report) {
  const std::lock_guard lock(watched_mutex);
  watched = {.folder = folder, .report = report, .before = io::find_identity(report)};
}

void watch_workspace(const std::filesystem::path& folder) {
  const std::lock_guard lock(watched_mutex);
  watched_workspace = folder;
}

void note_complete_results() {
  const std::lock_guard lock(watched_mutex);
  watched->are_complete = true;
}

std::string complete_results() {
  const std::lock_guard lock(watched_mutex);
  return watched && watched->are_complete ? completeness(*watched) : "";
}

void wait_if_interrupted() {
  while (interrupted) pause();
}

}  // namespace lacuna::tools
