// SPDX-License-Identifier: Apache-2.0
#include "tools/run/run_program.hpp"

#include "engine/run/error.hpp"
#include "engine/store/temporary_folder.hpp"
#include "io/read/files/input_file.hpp"
#include "tools/console/command_line.hpp"
#include "tools/console/terminal.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <pthread.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
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

namespace {

constexpr const char* kNoMoreThreads = "the system has no more memory or threads for this process";

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

// Returns a line. The middle of a long one is left out, such as of a name that a file has.
std::string one_line(std::string text) {
  constexpr std::size_t kMost = 1000;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  if (text.size() > kMost) text.replace(kMost / 2, text.size() - kMost, " ... ");
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

struct Least {
  __rlimit_resource resource;
  rlim_t least, unit;
  const char *what, *name;
};
constexpr Least kLeast[] = {{RLIMIT_STACK, 1 << 20, 1 << 10, "KiB of stack", "ulimit -s"},
                            {RLIMIT_NOFILE, 256, 1, "open files", "ulimit -n"}};

const char* started_as = "lacuna";

// For the time before `main`, where no library works yet.
template <class... Values>
[[noreturn]] void end_at_start(const char* format, Values... values) {
  ::dprintf(STDERR_FILENO, "%s: error: ", started_as);
  ::dprintf(STDERR_FILENO, format, values...);
  ::_exit(kFailed);
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
    remove_temporary_folders();
    remove_made_folders();
    print_error(kNoMoreThreads);
    std::_Exit(kFailed);
  });
  handle_signals();
}

}  // namespace

void check_limits(int, char** words, char**) {
  if (const char* const end = words[0] ? std::strrchr(words[0], '/') : nullptr) started_as = end + 1;
  std::set_terminate([] { end_at_start("%s\n", kNoMoreThreads); });
  for (const auto& [resource, least, unit, what, name] : kLeast) {
    rlimit limit{};
    if (::getrlimit(resource, &limit) == 0 && limit.rlim_cur < least)
      end_at_start("the system allows this process %llu %s (%s); allowed: %llu or more\n",
                   static_cast<unsigned long long>(limit.rlim_cur / unit), what, name,
                   static_cast<unsigned long long>(least / unit));
  }
}

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
    return fail("out of memory; a lower --memory-limit may help, of commands that have it", kFailed);
  } catch (const std::filesystem::filesystem_error& error) {  // such as a name that is too long
    return fail(one_line(error.path1().string() + ": " + error.code().message()), kFailed);
  } catch (const std::exception& error) {
    return fail(one_line(error.what()), kFailed);
  }
}

namespace fs = std::filesystem;

FolderLock::FolderLock(const fs::path& folder)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (!folder_.is_open()) throw Error(folder.string() + ": cannot be opened: " + std::strerror(errno));
  while (::flock(folder_.number(), LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    if (reason == EINTR) continue;
    if (reason == EWOULDBLOCK) throw FolderInUse(folder.string() + ": another run is at work there");
    if (reason != EOPNOTSUPP && reason != ENOLCK && reason != ENOSYS)
      throw Error(folder.string() + ": cannot be locked: " + std::strerror(reason));
    spdlog::warn("{}: its file system knows no locks; no other run may use the folder meanwhile",
                 folder.string());
    return;
  }
}

bool FolderLock::holds(const fs::path& folder) const {
  struct stat locked {
  }, named{};
  return ::fstat(folder_.number(), &locked) == 0 && ::stat(folder.c_str(), &named) == 0 &&
         locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
}

namespace {

// If `a` is missing, a/../b becomes b.
fs::path without_detours(const fs::path& folder) {
  fs::path begin;
  for (const fs::path& part : folder) {
    std::error_code error;
    if (part == ".." && !begin.empty() && !fs::exists(begin, error)) return fs::weakly_canonical(folder);
    begin /= part;
  }
  return folder;
}

// Returns the folder and those that it is in, without links, innermost first.
std::vector<fs::path> folders_around(const fs::path& folder) {
  std::error_code error;
  fs::path around = fs::weakly_canonical(fs::absolute(folder), error);
  if (error) around = fs::absolute(folder);
  if (!around.has_filename()) around = around.parent_path();
  std::vector<fs::path> all = {around};
  for (; around != around.root_path(); around = around.parent_path()) all.push_back(around.parent_path());
  return all;
}

// A later run removes what a killed one has left.
void require_lasting(const fs::path& folder) {
  for (const fs::path& around : folders_around(folder)) {
    if (is_temporary_folder(around))
      throw UsageError(folder.string() + ": is in the temporary folder of a run " + around.string() +
                       "; allowed: another place");
  }
}

std::recursive_mutex mutex;       // of the list, and while folders are made and removed
std::vector<MadeFolder*> living;  // in the order made

// Returns the folder that holds, or will hold, the folder of this name.
fs::path parent_of(const fs::path& folder) {
  const fs::path name = folder.has_filename() ? folder : folder.parent_path();
  return name.has_parent_path() ? name.parent_path() : ".";
}

}  // namespace

MadeFolder::MadeFolder(const fs::path& folder) : folder_(without_detours(folder)) {
  const std::lock_guard lock(mutex);
  std::error_code error;
  const fs::file_status status = fs::status(folder_, error);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw Error(folder_.string() + ": not a folder");
  }
  if (status.type() == fs::file_type::none)  // such as a name that is too long
    throw Error(folder_.string() + ": cannot create the folder: " + error.message());
  if (std::error_code no_link; fs::is_symlink(folder_, no_link) && !fs::exists(status))
    throw Error(folder_.string() + ": a link to " + fs::read_symlink(folder_).string() +
                ", which is missing; allowed: a folder, or a name that is free");
  for (fs::path missing = folder_; !missing.empty() && !fs::exists(missing, error);
       missing = missing.parent_path()) {
    if (missing.has_filename()) made_.push_back(missing);
    if (missing == missing.parent_path()) break;
  }
  fs::create_directories(folder_, error);
  if (error && !fs::is_directory(folder_)) {
    throw Error(folder_.string() + ": cannot create the folder: " + error.message());
  }
  if (access(folder_.c_str(), W_OK | X_OK) != 0) {
    throw Error(folder_.string() + ": cannot write to the folder: " + std::strerror(errno));
  }
  living.push_back(this);
}

MadeFolder::~MadeFolder() {
  const std::lock_guard lock(mutex);
  std::erase(living, this);
  remove_empty();
}

void MadeFolder::remove_empty() {
  const std::lock_guard lock(mutex);
  for (const fs::path& folder : made_) {
    if (rmdir(folder.c_str()) != 0) break;  // it holds something, for which it was made
  }
  leave();
}

void MadeFolder::leave() {
  const std::lock_guard lock(mutex);
  made_.clear();
}

OutFolder::OutFolder(const fs::path& folder, const std::string& file)
    : parent_((require_lasting(folder), parent_of(folder))) {
  const RemovalPause pause;  // a signal waits until its line can name the folder
  results_.emplace(folder);
  watch_results(folder, folder / file);
}

KeptFolder::KeptFolder(const fs::path& folder) {
  do {  // another process may remove the empty folder before it is locked
    lock_.reset();
    folder_.emplace(folder);
    try {
      lock_.emplace(path());
    } catch (const FolderInUse&) {
      folder_->leave();
      throw;
    } catch (const Error&) {
      if (fs::exists(path())) throw;
    }
  } while (!lock_ || !lock_->holds(path()));
}

KeptFolder::~KeptFolder() {
  folder_->remove_empty();  // before another process can lock it
}

void require_outside_results(const fs::path& folder, const fs::path& out, const std::string& option) {
  if (folder.empty()) return;
  const fs::path results = out.empty() ? out : folders_around(out).front();
  for (const fs::path& around : folders_around(folder)) {
    if (around == results || io::is_result_folder(around))
      throw UsageError(folder.string() + ": is in the folder of results " + around.string() +
                       "; allowed: another one for " + option);
  }
  require_lasting(folder);
}

void remove_made_folders() {
  mutex.lock();  // and never unlocked
  for (auto folder = living.rbegin(); folder != living.rend(); ++folder) (*folder)->remove_empty();
}

}  // namespace lacuna::tools
