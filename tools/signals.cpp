#include "tools/signals.hpp"

#include "engine/core/error.hpp"
#include "tools/terminal.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <pthread.h>
#include <unistd.h>

namespace lacuna {
namespace {

std::mutex paths_mutex;
std::vector<std::filesystem::path> paths;
std::atomic<bool> interrupted = false;

// Other threads may still be adding files, so removing takes several rounds.
void remove_persistently(const std::filesystem::path& path) {
  for (int round = 0; round < 100; ++round) {
    std::error_code error;
    std::filesystem::remove_all(path, error);
    if (!error && !std::filesystem::exists(path, error)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

void wait_for_signal(sigset_t signals) {
  int signal = 0;
  sigwait(&signals, &signal);
  interrupted = true;
  clear_progress_now();
  const std::lock_guard lock(paths_mutex);  // kept: nothing is added any more
  for (const auto& path : paths) remove_persistently(path);
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

void remove_on_signal(const std::filesystem::path& path) {
  const std::lock_guard lock(paths_mutex);
  paths.push_back(std::filesystem::absolute(path));
}

std::filesystem::path make_removed_on_signal(const std::function<std::filesystem::path()>& make) {
  const std::lock_guard lock(paths_mutex);
  const std::filesystem::path path = make();
  paths.push_back(std::filesystem::absolute(path));
  return path;
}

void keep_on_signal(const std::filesystem::path& path) {
  const std::lock_guard lock(paths_mutex);
  std::erase(paths, std::filesystem::absolute(path));
}

void wait_if_interrupted() {
  while (interrupted) pause();
}

}  // namespace lacuna
