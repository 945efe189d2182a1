// Folders that a run makes, and takes away again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

// A folder that exists afterwards, with its parents. What was made for it and is still empty at the end is
// removed, so that a failed run leaves nothing behind.
class MadeFolder {
 public:
  // Throws `Error` if the path is no folder, cannot be made or cannot be written to.
  explicit MadeFolder(std::filesystem::path folder);
  ~MadeFolder();
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // innermost first
};

// Keeps other runs from writing to an existing folder. Throws `Error` where one does. It goes with the
// process, however that ends.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

// A fresh folder with a unique name, `prefix` and six more letters; removed with all it holds at the end,
// and when a signal ends the program.
class Workspace {
 public:
  Workspace(const std::filesystem::path& parent, const std::string& prefix, bool keep);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
  bool keep_;
};

// Folders that earlier runs left in `parent`, by the prefix of their names, in order.
std::vector<std::filesystem::path> find_workspaces(const std::filesystem::path& parent,
                                                   const std::string& prefix);

}  // namespace lacuna
