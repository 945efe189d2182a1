// SPDX-License-Identifier: Apache-2.0
// The frame of both programs, `lacuna` and `lacuna-bench`: the process, its errors, its exit codes and its
// signals. It has the folders that commands make and lock, too.
#pragma once

#include "engine/run/error.hpp"
#include "engine/store/store_file.hpp"
#include "engine/store/temporary_folder.hpp"
#include "io/read/files/output_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lacuna::tools {

class CommandLine;

// Ends a command whose answer is no, such as that an area has voids. It is no error: all was done.
struct AnswerIsNo {
  std::string answer;
  bool is_decided = true;  // false: neither yes nor no
};

// Ends the process with one line if the system allows it too little. Libraries start threads before `main`.
// So a program names this function in its section .preinit_array, which comes before them.
void check_limits(int count, char** words, char** environment);

// Runs the command that the arguments name. `name` is the program's, before each line on stderr. Returns the
// exit code. 0: done; 1: failed, or the answer is no; 2: wrong usage; 3: the answer is not decided. But for 0
// there is one line on stderr. A signal n ends the process with the exit code 128 + n.
int run_program(const std::string& name, CommandLine& line, int argc, char** argv);

// Ctrl-C and kill: the program ends at once, after it has removed its temporary files from the disk.

// From now on SIGINT, SIGTERM and SIGHUP remove the temporary folders (engine/store/temporary_folder.hpp) and
// empty folders that were made for the run. They print one line, if stderr takes it
// at once, and end the program with exit code 128 + signal. Call before any other thread starts. The signals
// are blocked in all threads and awaited in one of its own, where, unlike in a signal handler, removing files
// is safe. Throws `Error` if that thread cannot be started.
void handle_signals();

// The run replaces results in `folder`, all or none; `report` is one of them, and shows by its identity
// whether that has happened. From now on the line about a signal says so: "lacuna: interrupted; DIR is as it
// was".
void watch_results(const std::filesystem::path& folder, const std::filesystem::path& report);

// This folder keeps finished work, and the line about a signal says so.
void watch_workspace(const std::filesystem::path& folder);

// The results have replaced the files in the folder of watch_results.
void note_complete_results();
// Returns a text for the line of a later error: "; the results in DIR are complete"; empty before.
std::string complete_results();

// Does not return if a signal is ending the program: what fails meanwhile fails because of it.
void wait_if_interrupted();

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
