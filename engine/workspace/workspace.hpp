// SPDX-License-Identifier: Apache-2.0
// A workspace that is kept: a folder of sealed parts, from which the same run goes on after a stop.
//
// There is no list of what is done. Each part says by itself what it was made from (store/sealed_part.hpp),
// so the names of the parts are all that several processes share.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/points.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lacuna {

// Where a run keeps its sealed parts.
struct Workspace {
  std::filesystem::path folder;  // empty: nothing is kept
  std::string made_from;         // input and parameters of the parts, a line each
  bool is_unit = false;          // one of several processes that make parts of the run: it removes none

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

enum class WorkspaceNote {
  kTasks,    // of a step, where several processes share the run
  kResults,  // the folder that has the results of the last complete run
};

// The data of a run in its workspace, from which another process can do a part of the run.
struct StoredRun {
  std::vector<std::string> names;  // `PointSource::names`
  std::string note;                // as `RunConfig::note` was
};
// Reads the data of the run. Throws `Error` where the folder is no workspace.
StoredRun read_run(const std::filesystem::path& folder);
// Returns what the parts are made from, a line each. Returns nothing where the part of the run is damaged:
// the run makes it again.
std::optional<std::vector<std::string>> made_from_of(const std::filesystem::path& folder);

// Write and read a line of text as a part of its own. The result is empty where there is no such part.
void write_note(const std::filesystem::path& folder, WorkspaceNote note, const std::string& text);
std::optional<std::string> read_note(const std::filesystem::path& folder, WorkspaceNote note);

// Begins an update: moves the data of the run into a folder of the workspace, and removes the other parts. If
// a stopped update has left such a folder, this is done. `end_update` removes the folder.
void begin_update(const std::filesystem::path& folder);
void end_update(const std::filesystem::path& folder);
std::filesystem::path earlier_run(const std::filesystem::path& folder);  // where its data are, if they are
// Returns a folder for results of the run before. `end_update` removes it, too.
std::filesystem::path earlier_results(const std::filesystem::path& folder);

bool is_workspace(const std::filesystem::path& folder);

// Return names of parts: the points of a level, and outputs of its tiles.
std::filesystem::path level_path(const std::filesystem::path& folder, std::size_t level);
std::filesystem::path tiles_prefix(const std::filesystem::path& folder, std::size_t level);

// Returns the level whose points, or outputs of tiles, a file has. Returns nothing if the file has other
// things.
std::optional<std::size_t> level_of_part(const std::filesystem::path& file);
std::optional<std::size_t> level_of_outputs(const std::filesystem::path& file);

// Returns the files of a workspace, without others in the folder. Returns nothing where it is no workspace.
std::vector<std::filesystem::path> workspace_files(const std::filesystem::path& folder);

// Removes one of the files.
void remove_part(const std::filesystem::path& file);

}  // namespace lacuna
