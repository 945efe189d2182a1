// SPDX-License-Identifier: Apache-2.0
#include "engine/store/temporary_storage.hpp"

#include "engine/run/job.hpp"

#include <cstdint>

namespace lacuna {

TemporaryStorage::TemporaryStorage(const PointSource& scan, RunConfig& run) {
  constexpr std::uint64_t kBytesPerPoint = 160;  // more than any scan of bench/NOTES.md took
  const std::uint64_t limit = Memory::share(run.memory_limit).limit;
  const std::uint64_t most = limit / 2 / kBytesPerPoint;  // points
  if (run.scratch.empty() && scan.expected_points().value_or(UINT64_MAX) <= most) {
    run.memory_limit = limit - *scan.expected_points() * kBytesPerPoint;
  } else {
    namespace fs = std::filesystem;
    folder_.emplace(run.scratch.empty() ? fs::temp_directory_path() : fs::path(run.scratch), "lacuna-");
  }
}

}  // namespace lacuna
