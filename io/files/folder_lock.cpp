// SPDX-License-Identifier: Apache-2.0
#include "io/files/folder_lock.hpp"

#include "engine/run/error.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lacuna::io {

namespace fs = std::filesystem;

FolderLock::FolderLock(const fs::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) throw Error(folder.string() + ": cannot be opened: " + std::strerror(errno));
  while (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    if (reason == EINTR) continue;
    if (reason == EOPNOTSUPP || reason == ENOLCK || reason == ENOSYS) {
      spdlog::warn("{}: its file system knows no locks; no other run may use the folder meanwhile",
                   folder.string());
      return;
    }
    ::close(descriptor_);
    if (reason == EWOULDBLOCK) throw Error(folder.string() + ": another run is at work there");
    throw Error(folder.string() + ": cannot be locked: " + std::strerror(reason));
  }
}

FolderLock::~FolderLock() {
  ::close(descriptor_);
}

bool FolderLock::holds(const fs::path& folder) const {
  struct stat locked {
  }, named{};
  return ::fstat(descriptor_, &locked) == 0 && ::stat(folder.c_str(), &named) == 0 &&
         locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
}

}  // namespace lacuna::io
