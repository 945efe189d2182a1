// SPDX-License-Identifier: Apache-2.0
// What a run has: its settings, and what it may use of the machine. Steps that use most of it take all of it,
// other functions take what they use.
#pragma once

#include "engine/config/config.hpp"
#include "engine/run/parallel.hpp"
#include "engine/run/phase.hpp"

#include <filesystem>
#include <memory>
#include <utility>

namespace lacuna {

inline Workers workers_of(const RunConfig& config) {
  return {TaskArena(static_cast<std::size_t>(config.threads)), Memory::share(config.memory_limit)};
}

struct Job {
  Job(const Config& config, std::filesystem::path folder, Progress& progress)
      : config(config),
        workers(workers_of(config.run)),
        spill{std::move(folder), std::make_shared<BufferPool>(workers.memory.lists)},
        phases{progress, workers.memory} {}

  const Config& config;
  Workers workers;
  Spill spill;
  Phases phases;
};

}  // namespace lacuna
