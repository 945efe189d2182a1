#include "tools/signals.hpp"

#include "engine/run/error.hpp"
#include "engine/store/temporary_folder.hpp"
#include "tools/terminal.hpp"

#include <atomic>
#include <csignal>
#include <string>
#include <system_error>
#include <thread>

#include <pthread.h>
#include <unistd.h>

namespace lacuna {
namespace {

std::atomic<bool> interrupted = false;

void wait_for_signal(sigset_t signals) {
  int signal = 0;
  sigwait(&signals, &signal);
  interrupted = true;
  clear_progress_now();
  remove_temporary_folders();
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

void wait_if_interrupted() {
  while (interrupted) pause();
}

}  // namespace lacuna
