// SPDX-License-Identifier: Apache-2.0
#include "tools/run/folder_lock.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/stat.h>

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

}  // namespace lacuna::tools
