// SPDX-License-Identifier: Apache-2.0
#include "tools/run/folders.hpp"

#include "engine/run/error.hpp"

#include <cerrno>
#include <cstring>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>

namespace lacuna::tools {

namespace fs = std::filesystem;

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

std::mutex mutex;                       // of the list, and while folders are made
std::vector<const MadeFolder*> living;  // in the order made

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

void MadeFolder::remove_empty() const {
  for (const fs::path& folder : made_) {
    if (rmdir(folder.c_str()) != 0) return;  // it holds something, for which it was made
  }
}

fs::path parent_of(const fs::path& folder) {
  const fs::path name = folder.has_filename() ? folder : folder.parent_path();
  return name.has_parent_path() ? name.parent_path() : ".";
}

Option add_results_folder(const Command& command, fs::path& folder) {
  return command.add_option("DIR", folder, "Folder with the results of lacuna detect").type("DIR").required();
}

void remove_made_folders() {
  mutex.lock();  // and never unlocked
  for (auto folder = living.rbegin(); folder != living.rend(); ++folder) (*folder)->remove_empty();
}

}  // namespace lacuna::tools
