#include "tools/workspace.hpp"

#include "engine/core/error.hpp"
#include "tools/signals.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace lacuna {

namespace fs = std::filesystem;

MadeFolder::MadeFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  const fs::file_status status = fs::status(folder_, error);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw Error(folder_.string() + ": not a folder");
  }
  for (fs::path missing = folder_; !missing.empty() && !fs::exists(missing, error);
       missing = missing.parent_path()) {
    if (missing.has_filename()) made_.push_back(missing);
    if (missing == missing.parent_path()) break;
  }
  fs::create_directories(folder_, error);
  if (error && !fs::is_directory(folder_)) {
    throw Error(folder_.string() + ": cannot make the folder: " + error.message());
  }
  if (access(folder_.c_str(), W_OK | X_OK) != 0) {
    throw Error(folder_.string() + ": cannot write to the folder: " + std::strerror(errno));
  }
}

MadeFolder::~MadeFolder() {
  for (const fs::path& folder : made_) {
    if (rmdir(folder.c_str()) != 0) return;  // it holds something: that is what it was made for
  }
}

// Where a file system knows no locks, runs are on their own.
FolderLock::FolderLock(const fs::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw Error(folder.string() + ": another run writes its results there");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Workspace::Workspace(const fs::path& parent, const std::string& prefix, bool keep) : keep_(keep) {
  const auto make = [&] {
    std::string name = (parent / (prefix + "XXXXXX")).string();
    if (!mkdtemp(name.data())) {
      throw Error(parent.string() + ": cannot make a workspace: " + std::strerror(errno));
    }
    return fs::path(name);
  };
  folder_ = keep_ ? make() : make_removed_on_signal(make);
}

Workspace::~Workspace() {
  if (keep_) return;
  std::error_code error;  // nothing to be done about it
  fs::remove_all(folder_, error);
  keep_on_signal(folder_);
}

std::vector<fs::path> find_workspaces(const fs::path& parent, const std::string& prefix) {
  std::vector<fs::path> found;
  std::error_code error;  // what cannot be read has none
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, error)) {
    if (entry.is_directory(error) && entry.path().filename().string().starts_with(prefix))
      found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace lacuna
