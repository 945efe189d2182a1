// SPDX-License-Identifier: Apache-2.0
// A workspace that is kept: a folder of sealed parts, from which the same run goes on after a stop.
//
// There is no list of what is done. Each part says by itself what it was made from (store/sealed_part.hpp),
// so the names of the parts are all that several processes share.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/points.hpp"
#include "engine/model/task_share.hpp"
#include "engine/store/sealed_part.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lacuna {

// How several processes share a run.
struct TaskPlan {
  std::size_t tasks = 1;          // of each step that is shared
  std::size_t levels = 0;         // whose steps are shared, from the first level on
  std::uint64_t tile_points = 0;  // of each task's tiles, at most
  bool reads = false;             // whether reading the scan is shared
};

// Returns the fingerprint of a part that one of several tasks makes.
Digest digest_of(const std::string& made_from, const TaskShare& share);
// Returns a checksum as a line of what another part is made from.
std::string line_of(const Digest& checksum);

// Returns the config with tiles as large as the plan of its workspace has them, unless it says how large.
Config with_planned_tiles(Config config);

// Returns how many tasks make a level.
inline std::size_t tasks_of(std::size_t level, const TaskPlan& plan) {
  return level < plan.levels && (level > 0 || plan.reads) ? plan.tasks : 1;
}

// Where a run keeps its sealed parts.
struct Workspace {
  std::filesystem::path folder;  // empty: nothing is kept
  std::string made_from;         // input and parameters of the parts, a line each
  TaskPlan plan;
  bool is_unit = false;  // one of several processes that make parts of the run: it removes none

  bool is_kept() const { return !folder.empty(); }
};

// Opens the workspace that the config names, for this input. Removes unfinished files of a stopped run; a
// unit does not. Throws `Error` where the folder is not a workspace, or belongs to another input or other
// parameters. The error has the first difference.
Workspace open_workspace(const PointSource& scan, const Config& config, bool is_unit = false);

// Returns further parameters on which the evaluation of a tile depends, a line each.
std::string evaluation_parameters(const Config& config);
// Returns the parameters that say which outputs of a tile are wanted.
std::string output_parameters(const Config& config);

// The data of a run in its workspace, from which another process can do a part of the run.
struct KeptRun {
  std::vector<std::string> names;  // `PointSource::names`
  std::string note;                // as `RunConfig::note` was
};
// Reads the data of the run. Throws `Error` where the folder is no workspace.
KeptRun read_run(const std::filesystem::path& folder);
// Returns what the parts are made from, a line each. Returns nothing where the part of the run is damaged:
// the run makes it again.
std::optional<std::vector<std::string>> made_from_of(const std::filesystem::path& folder);

// Write and read the plan of a run. The result is empty where none was made.
void write_plan(const std::filesystem::path& folder, const TaskPlan& plan);
std::optional<TaskPlan> read_plan(const std::filesystem::path& folder);

bool is_workspace(const std::filesystem::path& folder);

// Return how names of files begin, for the points of a level, and for the outputs of its tiles.
std::filesystem::path level_prefix(const std::filesystem::path& folder, std::size_t level);
std::filesystem::path tiles_prefix(const std::filesystem::path& folder, std::size_t level);

// Return the level that a file is of. It is a part of the level's points, a column of them, or has outputs of
// tiles.
std::optional<std::size_t> level_of_part(const std::filesystem::path& file);
std::optional<std::size_t> level_of_column(const std::filesystem::path& file);
std::optional<std::size_t> level_of_outputs(const std::filesystem::path& file);

// Returns the files of a workspace, without others in the folder. Returns nothing where it is no workspace.
std::vector<std::filesystem::path> workspace_files(const std::filesystem::path& folder);

// Fails because a part is gone that this process has sealed.
[[noreturn]] void fail_replaced(const Workspace& workspace);

// Removes one of the files.
void remove_part(const std::filesystem::path& file);

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
      remove_part(error.file());
    }
  }
}

}  // namespace lacuna
