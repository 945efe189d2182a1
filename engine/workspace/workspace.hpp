// A workspace that is kept: a folder of sealed parts, from which the same run goes on after a stop.
//
// There is no list of what is done. Each part says by itself what it was made from (store/sealed_part.hpp),
// so the names of the parts are all that several processes share.
#pragma once

#include "engine/config.hpp"
#include "engine/model/points.hpp"
#include "engine/run/job.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lacuna {

// Opens the workspace that the config names, for this input, and sets `kept` and `made_from` of the job. What
// a stopped run has left unfinished is removed. Throws `Error` where the folder is no workspace, or that of
// another input or of other parameters, with the first difference.
void open_workspace(const PointSource& scan, Job& job);

// Further parameters on which the evaluation of a tile depends, a line each.
std::string evaluation_parameters(const Config& config);
// Parameters that say which outputs of a tile are wanted.
std::string output_parameters(const Config& config);

// What a workspace knows of its run, so that another process can do a part of it.
struct StoredRun {
  std::vector<std::string> inputs;  // `PointSource::names`
  Config config;
};
// Throws `Error` where the folder is no workspace.
StoredRun read_run(const std::filesystem::path& folder);

// Names of parts: the points of a level, and outputs of its tiles.
std::filesystem::path level_path(const std::filesystem::path& folder, std::size_t level);
std::filesystem::path tiles_prefix(const std::filesystem::path& folder, std::size_t level);

// The files of a workspace, without others that lie in the folder; none where it is no workspace.
std::vector<std::filesystem::path> workspace_files(const std::filesystem::path& folder);

// What a workspace has of a level.
struct LevelState {
  std::size_t number = 0;     // from 0
  std::uint64_t points = 0;   // distinct ones
  std::size_t tiles = 0;      // 0: the level's points are not all there
  std::size_t evaluated = 0;  // tiles
};
struct WorkspaceState {
  std::vector<std::string> made_from;  // a line each
  std::vector<LevelState> levels;
  std::uint64_t bytes = 0;  // of all files
};

// Reads the tables of the parts, and not whether the parts are whole. None where the folder is no workspace.
std::optional<WorkspaceState> state_of_workspace(const std::filesystem::path& folder);

// Removes one of the files.
void remove_part(const std::filesystem::path& file);

}  // namespace lacuna
