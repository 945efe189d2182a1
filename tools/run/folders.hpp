// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/run/error.hpp"
#include "engine/store/descriptor.hpp"
#include "engine/store/temporary_folder.hpp"
#include "io/read/files/result_folder.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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

// The folders of a command: those that the user names, and those for its temporary files.

// A folder that exists afterwards, with its parents. At the end it removes the folders that it made and that
// are still empty, so that a failed run leaves nothing behind.
class MadeFolder {
 public:
  // Throws `Error` if the path is no folder, cannot be made or cannot be written to.
  explicit MadeFolder(const std::filesystem::path& folder);
  ~MadeFolder();
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

  // Returns the folder as named, but of a/../b only b, so that no `a` is made on the way.
  const std::filesystem::path& path() const { return folder_; }

  // Removes the folders that it made, innermost first, up to one that holds something.
  void remove_empty();
  void leave();  // it removes none any more

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // innermost first
};

// The folder of results that a command writes, with its parents. From now on the line about a signal says
// whether it is as it was.
class OutFolder {
 public:
  // `file`: the result whose identity shows that the results have been replaced.
  OutFolder(const std::filesystem::path& folder, const std::string& file);

  io::ResultFolder& results() { return *results_; }

 private:
  MadeFolder parent_;
  std::optional<io::ResultFolder> results_;
};

// The kept folder of a run, which this process alone uses. It goes at the end if it was made and is still
// empty.
class KeptFolder {
 public:
  // Throws `Error`, also if another process uses it.
  explicit KeptFolder(const std::filesystem::path& folder);
  ~KeptFolder();

  const std::filesystem::path& path() const { return folder_->path(); }

 private:
  std::optional<MadeFolder> folder_;
  std::optional<FolderLock> lock_;
};

// A folder in `parent` for the temporary files of a command.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::filesystem::path& parent)
      : parent_(parent), folder_(parent_.path(), kScratchPrefix) {}

  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  MadeFolder parent_;
  TemporaryFolder folder_;
};

// Refuses a folder for kept or temporary files in a folder of results, which is replaced as a whole. The
// temporary folder of a run is refused, too. `out`: the results of this run, if it has any.
void require_outside_results(const std::filesystem::path& folder, const std::filesystem::path& out,
                             const std::string& option);

// For the thread that handles signals: removes the folders of all living MadeFolders that are empty. No
// folder can be made afterwards: a thread that tries stops there, as the process is about to end.
void remove_made_folders();

}  // namespace lacuna::tools
