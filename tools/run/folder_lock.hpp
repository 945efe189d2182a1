// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/run/error.hpp"
#include "engine/store/descriptor.hpp"

#include <filesystem>

namespace lacuna::tools {

struct FolderInUse : Error {
  using Error::Error;
};

// Keeps other runs from an existing folder, as long as the lock lives. The lock goes with the process,
// however that ends. Throws `FolderInUse` if another run has the lock, and `Error` if it cannot be had. On a
// file system that knows no locks, the log has a warning.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);

  // Whether the locked folder still has this name: another run may have removed it just before.
  bool holds(const std::filesystem::path& folder) const;

 private:
  Descriptor folder_;
};

}  // namespace lacuna::tools
