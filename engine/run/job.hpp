// SPDX-License-Identifier: Apache-2.0
// The data that all passes over the scan share: settings, threads, memory, the workspace and the progress.
#pragma once

#include "engine/config/config.hpp"
#include "engine/model/detection.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/progress.hpp"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace lacuna {

// The shares of the memory limit. All data of the scan's size is within these shares, save a few bits a point
// (active, coherent, on a loop).
struct Memory {
  std::uint64_t limit;    // all of it; where the config has none, half of what the process may have
  std::uint64_t cells;    // survey and index
  std::uint64_t tiles;    // all tiles at work together
  std::uint64_t spills;   // buffers of all lists on their way to disk
  std::uint64_t global;   // spanning graph and loops, sorts
  std::uint64_t reading;  // the part that a reader of the scan holds; survey and index are apart

  static Memory share(std::uint64_t limit);
};

struct Job {
  Job(const Config& config, std::filesystem::path workspace, Progress& progress);

  const Config& config;
  std::filesystem::path workspace;
  Progress& progress;
  TaskArena arena;
  Memory memory;
  std::vector<PhaseTime> phases;
  bool is_in_phase = false;

  // Returns freed memory to the system, if more than `share` of the limit is in use. Call it at the end of
  // each phase, between steps that need much, and within a phase where the limit is near.
  void trim(double share = 0.5) const;
  // Returns the path of a temporary file.
  std::filesystem::path file(std::string_view name) const { return workspace / name; }
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
