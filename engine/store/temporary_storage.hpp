// SPDX-License-Identifier: Apache-2.0
// Where a run in another program's process keeps temporary data that does not fit in its memory.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/points.hpp"
#include "engine/store/temporary_folder.hpp"

#include <filesystem>
#include <optional>

namespace lacuna {

// Uses files in memory, where they fit within half of the limit. Else it uses a folder in `run.scratch`, or
// in the system's folder for temporary files. The folder is removed with this object.
class TemporaryStorage {
 public:
  // Files in memory are taken from `run.memory_limit`. Throws `Error`.
  TemporaryStorage(const PointSource& scan, RunConfig& run);

  std::filesystem::path path() const { return folder_ ? folder_->path() : std::filesystem::path(); }

 private:
  std::optional<TemporaryFolder> folder_;
};

}  // namespace lacuna
