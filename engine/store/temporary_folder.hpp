// SPDX-License-Identifier: Apache-2.0
// Folders that this process makes for itself. They are removed when it ends, also by a signal, but not by
// SIGKILL.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace lacuna {

// How the names of temporary folders in an output folder begin.
inline constexpr const char* kTemporaryPrefix = ".lacuna-";

class TemporaryFolder {
 public:
  // Creates a folder in `parent`, for this user alone: `prefix` and six random characters. Throws `Error`.
  TemporaryFolder(const std::filesystem::path& parent, const std::string& prefix);
  // Takes over a folder of this process alone, and empties it. Throws `Error`.
  explicit TemporaryFolder(const std::filesystem::path& folder);
  ~TemporaryFolder();  // removes it with everything in it, if that is possible
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }

  void keep();  // nobody removes it any more

 private:
  std::filesystem::path folder_;
  bool is_kept_ = false;
};

// Returns the folder in which a run makes its temporary folder, where no results and no kept run have one.
// It is `scratch`, or the system's where that is empty. Throws `Error` where the system has none.
std::filesystem::path temporary_parent(const std::string& scratch);

struct RemainingFolder {
  std::filesystem::path folder;
  std::string reason;
};

// Returns the folders that could not be removed, after one more try each. For the end of a program, where no
// TemporaryFolder lives.
std::vector<RemainingFolder> remaining_folders();

// For the thread that handles signals: removes all temporary folders. No folder can be made afterwards: a
// thread that tries stops there, as the process is about to end.
void remove_temporary_folders();

// As long as it lives, remove_temporary_folders waits. The thread that has it may make and keep folders.
class RemovalPause {
 public:
  RemovalPause();

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

// Returns the folders in `parent` whose names begin with `prefix`, in order: earlier runs left them.
std::vector<std::filesystem::path> find_folders(const std::filesystem::path& parent,
                                                const std::string& prefix);

}  // namespace lacuna
