// SPDX-License-Identifier: Apache-2.0
// The data that all passes over the scan share: settings, threads, memory, temporary files and the
// progress.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/memory.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/progress.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace lacuna {

struct Job {
  Job(const Config& config, std::filesystem::path temporary, Progress& progress);

  const Config& config;
  std::filesystem::path temporary;  // the folder of temporary files
  Progress& progress;
  TaskArena arena;
  Memory memory;
  mutable MemoryLedger ledger;        // of `memory.work`
  std::shared_ptr<BufferPool> lists;  // results may outlive the job, and so do their lists
  std::vector<PhaseTime> phases;
  bool is_in_phase = false;

  // Returns freed memory to the system, if more than `share` of the limit is in use. Call it at the end of
  // each phase, between steps that need much, and within a phase where the limit is near.
  void trim(double share = 0.5) const;
  // Runs bodies with bounded memory (`TaskArena::for_each_within_budget`), and takes that memory from the
  // ledger.
  void for_each_within(std::uint64_t bytes, std::span<const std::uint64_t> needs,
                       const std::function<void(std::size_t)>& body) const;
  // Returns the path of a temporary file.
  std::filesystem::path file(std::string_view name) const { return temporary / name; }
  // Returns the points per tile: as the config has it, or enough tiles for all threads. They are never fewer
  // or more than memory allows. Throws `Error` where so many points can never fit.
  std::uint64_t tile_points(std::uint64_t points) const;
  // Returns the points in a cell of the index, so that all cells fit in memory.
  std::uint64_t cell_points(std::uint64_t points) const;
  // Returns the bytes that a tile with so many points takes while it is evaluated.
  std::uint64_t tile_bytes(std::uint64_t points) const;
};

// Times a phase and shows it, for as long as it lives. A phase within another is a part of it.
class Phase {
 public:
  Phase(Job& job, std::string_view name, std::uint64_t total);
  ~Phase();
  void advance(std::uint64_t count) {
    job_.trim(0.85);
    if (is_shown_) job_.progress.advance(count);
  }

 private:
  Job& job_;
  bool is_shown_;
  double start_;
};

}  // namespace lacuna
