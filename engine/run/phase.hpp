// SPDX-License-Identifier: Apache-2.0
// The phases of a run: how far they are, and how long they take.
#pragma once

#include "engine/run/memory.hpp"
#include "engine/run/progress.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna {

struct Phases {
  Progress& progress;
  const Memory& memory;  // trimmed within a phase and after it
  std::vector<PhaseTime> times = {};
  bool is_in_phase = false;
};

// Times a phase and shows it, for as long as it lives. A phase within another is a part of it.
class Phase {
 public:
  Phase(Phases& phases, std::string_view name, std::uint64_t total)
      : phases_(phases), is_shown_(!std::exchange(phases.is_in_phase, true)) {
    if (!is_shown_) return;
    phases_.times.push_back({std::string(name), 0});
    phases_.progress.begin(name, total);
  }
  ~Phase() {
    phases_.memory.trim();
    if (!is_shown_) return;
    phases_.is_in_phase = false;
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
    phases_.times.back().seconds = taken.count();
    phases_.progress.end();
  }
  void advance(std::uint64_t count) {
    phases_.memory.trim(0.85);
    if (is_shown_) phases_.progress.advance(count);
  }

 private:
  Phases& phases_;
  bool is_shown_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace lacuna
