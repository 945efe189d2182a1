// SPDX-License-Identifier: Apache-2.0
// The folders that the user names. The program makes missing ones, and locks them.
#pragma once

#include "tools/console/command_line.hpp"

#include <filesystem>
#include <vector>

namespace lacuna::tools {

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

  void remove_empty() const;  // the folders that it made, innermost first, up to one that holds something

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // innermost first
};

// Returns the folder that holds, or will hold, the folder of this name.
std::filesystem::path parent_of(const std::filesystem::path& folder);

// Adds the argument DIR of commands that begin with the results of a run.
Option add_results_folder(const Command& command, std::filesystem::path& folder);

// For the thread that handles signals: removes the folders of all living MadeFolders that are empty. No
// folder can be made afterwards: a thread that tries stops there, as the process is about to end.
void remove_made_folders();

}  // namespace lacuna::tools
