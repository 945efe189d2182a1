// SPDX-License-Identifier: Apache-2.0
// The run that a kept folder is of: its input, parameters and plan of tasks, and its files by their names.
// STEP-TASK.lacuna is a part. A column of a level has digits in place of the task, and its kind before the
// ending.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/points.hpp"
#include "engine/parts/parts.hpp"
#include "engine/store/sealed_part.hpp"

#include <filesystem>
#include <optional>
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

// Who opens a kept folder. A run removes the unfinished files of a stopped run. A unit is one of several
// processes at work: its input and parameters must be those of the plan.
enum class Opener { kRun, kPlan, kUnit };

// Returns whether tasks can share the reading of the source. It has parts, and all of its points are in the
// first level. Tasks that thin alone would leave several points in cells at their borders.
bool can_share_reading(const SourceParts& source, const Config& config);

// Opens the kept folder that the config names, for this input; without a name, nothing is kept. Where it is
// of another input or other parameters, the parts that differ are made again. Tasks share only what they
// can share with these. Throws `Error`, also where files of others have the names of parts, and to a unit
// whose folder has no plan, as after lacuna clean.
Parts open_parts(const PointSource& scan, const Config& config, Progress& progress, Opener opener);

// Return further parameters, a line each. The evaluation of a tile depends on the first, and the others say
// which outputs of a tile are wanted.
std::string evaluation_parameters(const Config& config);
std::string output_parameters(const Config& config);

// The data of a run from which another process can do a part of it.
struct KeptRun {
  std::vector<std::string> names;  // `SourceParts::names`
  std::string note;                // as `RunConfig::note` was
};
// Reads the data of the run. Throws `Error` where the folder keeps no run.
KeptRun read_run(const std::filesystem::path& folder);
// Returns the input and parameters of the run, a line each. Returns nothing where that part is damaged: the
// run makes it again.
std::optional<std::vector<std::string>> made_from_of(const std::filesystem::path& folder);

// Write and read the plan of a run. The result is empty where none was made, or where it is damaged.
void write_plan(const std::filesystem::path& folder, const TaskPlan& plan);
std::optional<TaskPlan> read_plan(const std::filesystem::path& folder);
// Returns the plan of a folder that must have one. Throws `Error`.
TaskPlan require_plan(const std::filesystem::path& folder);
// Returns the config with tiles as large as the plan of its folder has them, unless it says how large.
Config with_planned_tiles(Config config);

}  // namespace lacuna
