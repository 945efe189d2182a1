// SPDX-License-Identifier: Apache-2.0
#include "engine/store/temporary_storage.hpp"

#include "engine/run/job.hpp"

#include <algorithm>
#include <cstdint>

namespace lacuna {

bool take_files_into_memory(const PointSource& scan, RunConfig& run) {
  constexpr std::uint64_t kBytesPerPoint = 800;  // the most of docs/usage.md
  const std::uint64_t limit = Memory::share(run.memory_limit).limit;
  const std::uint64_t most = std::min(limit / 2, limit - std::min(limit, kLeastMemoryLimit));
  const std::optional<std::uint64_t> points = scan.expected_points();
  if (!run.scratch.empty() || !points || *points > most / kBytesPerPoint) return false;
  run.memory_limit = limit - *points * kBytesPerPoint;
  return true;
}

TemporaryStorage::TemporaryStorage(const PointSource& scan, RunConfig& run) {
  namespace fs = std::filesystem;
  if (!take_files_into_memory(scan, run))
    folder_.emplace(run.scratch.empty() ? fs::temp_directory_path() : fs::path(run.scratch), kScratchPrefix);
}

}  // namespace lacuna
