// SPDX-License-Identifier: Apache-2.0
#include "tools/run/folders.hpp"

#include "tools/run/run_program.hpp"

#include <cerrno>
#include <cstring>
#include <mutex>
#include <system_error>

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna::tools {

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
