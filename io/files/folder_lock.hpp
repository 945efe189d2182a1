// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace lacuna::io {

// Keeps other runs from an existing folder, as long as the lock lives. The lock goes with the process,
// however that ends. Throws `Error` if another run has the lock, or if it cannot be had. On a file system
// that knows no locks, the log has a warning.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  // Whether the locked folder still has this name: another run may have removed it just before.
  bool holds(const std::filesystem::path& folder) const;

 private:
  int descriptor_;
};

}  // namespace lacuna::io
