// SPDX-License-Identifier: Apache-2.0
// Where a run keeps its temporary data: in files in memory, or on a disk.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/points.hpp"
#include "engine/store/temporary_folder.hpp"

#include <filesystem>
#include <optional>

namespace lacuna {

// Returns whether all temporary files of a run fit within half of the memory limit, where no `run.scratch` is
// set. Then it takes them from `run.memory_limit`.
bool take_files_into_memory(const PointSource& scan, RunConfig& run);

// Serves a run in another program's process. It uses files in memory where they fit. Else it uses a folder in
// `run.scratch`, or in the system's folder for temporary files. The folder is removed with this object.
class TemporaryStorage {
 public:
  // Throws `Error`.
  TemporaryStorage(const PointSource& scan, RunConfig& run);

  std::filesystem::path path() const { return folder_ ? folder_->path() : std::filesystem::path(); }

 private:
  std::optional<TemporaryFolder> folder_;
};

}  // namespace lacuna
