// SPDX-License-Identifier: Apache-2.0
// The files of a kept folder, by their names. STEP-TASK.lacuna is a part. A column of a level has digits in
// place of the task, and its kind before the ending.
#pragma once

#include "engine/store/sealed_part.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

inline constexpr const char* kRunPart = "run.lacuna";  // the part that says whose folder it is
bool is_kept_folder(const std::filesystem::path& folder);
bool is_kept_name(const std::filesystem::path& file);  // whether it could be of a kept folder

std::filesystem::path part_file(const std::filesystem::path& folder, const std::string& step,
                                const std::string& task);
// Returns the files of a kept folder, without others in it. A part proves what the folder is; the run's own
// may be missing, where a process was at work while the folder was cleaned. Returns nothing where it is none.
std::vector<std::filesystem::path> kept_files(const std::filesystem::path& folder);
// Returns whether a file belongs to a step: "level-0".
bool is_of_step(const std::filesystem::path& file, const std::string& step);
// Removes one of the files.
void remove_kept(const std::filesystem::path& file);

// Does the work of a run. Where it finds a damaged file, it removes the file and begins again: what the file
// had is made anew.
template <class Work>
auto without_damaged_files(Work&& work) {
  constexpr int kMostDamaged = 1000;  // more are a broken disk
  for (int damaged = 0;; ++damaged) {
    try {
      return work();
    } catch (const DamagedFile& error) {
      if (damaged == kMostDamaged) throw;
      remove_kept(error.file());
    }
  }
}

}  // namespace lacuna
