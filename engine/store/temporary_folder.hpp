// SPDX-License-Identifier: Apache-2.0
// Folders that this process makes for itself. They are removed when it ends, also by a signal, but not by
// SIGKILL. What a killed process has left, a later one removes.
//
// A folder is known by its *mark*: a file whose name repeats the digits that were drawn for the folder. Its
// process keeps the mark locked. A folder is left if its mark is there, and free, and both are of this user.
// Its content is removed through its descriptor, and no link is followed. While a folder has no mark yet, or
// no longer, it is empty, and its mode shows whose it is: it is sticky. So nothing is removed that another
// program has made.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace lacuna {

// How the names of temporary folders begin: those in a folder that the user looks at, and others.
inline constexpr const char* kTemporaryPrefix = ".lacuna-";
inline constexpr const char* kScratchPrefix = "lacuna-";
inline constexpr std::size_t kDrawnDigits = 16;  // follow the prefix

struct MarkedFolder;

class TemporaryFolder {
 public:
  // Creates a folder in `parent`, for this user alone. Throws `Error`.
  TemporaryFolder(const std::filesystem::path& parent, const std::string& prefix);
  ~TemporaryFolder();  // removes it with everything in it, if that is possible
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  // Returns false on a file system that knows no locks. No process can see there that this one is at work.
  bool is_locked() const;

 private:
  std::filesystem::path folder_;
  MarkedFolder* made_;
};

// Returns the folder in which a run makes its temporary folder, where no results and no kept run have one.
// It is `scratch`, or the system's where that is empty. Throws `Error` where the system has none.
std::filesystem::path temporary_parent(const std::string& scratch);

// Removes the folders in `parent` that killed processes have left, as far as that is possible. First it calls
// rescue(folder) for each. Returns the other ones with this prefix that a process has, this one included.
std::vector<std::filesystem::path> remove_leftovers(
    const std::filesystem::path& parent, const std::string& prefix,
    const std::function<void(const std::filesystem::path&)>& rescue = [](const auto&) {});

// Returns whether a process has made this folder for itself, and may have left it.
bool is_temporary_folder(const std::filesystem::path& folder);

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

// As long as it lives, remove_temporary_folders waits. The thread that has it may make folders.
class RemovalPause {
 public:
  RemovalPause();

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

}  // namespace lacuna
