// SPDX-License-Identifier: Apache-2.0
// Reports of how far a run is. The engine reports, and the terminal decides what to show.
#pragma once

#include "engine/export.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace lacuna {

// An exception that `begin` or `advance` throws ends the run, which throws it again.
class LACUNA_API Progress {
 public:
  virtual ~Progress() = default;
  // A new phase begins: `total` points will pass through it; 0: not known.
  virtual void begin(std::string_view phase, std::uint64_t total) = 0;
  // `count` more have passed. Any thread may call this, and several may do so at a time.
  virtual void advance(std::uint64_t count) = 0;
  virtual void end() noexcept = 0;
  // A kept part of a step, such as "level-0", is made again. Steps that follow from it may be, too.
  virtual void make_again(std::string_view /*step*/) {}
};

struct PhaseTime {
  std::string name;
  double seconds = 0;
};

// A progress that reports nothing.
class NoProgress final : public Progress {
 public:
  void begin(std::string_view, std::uint64_t) override {}
  void advance(std::uint64_t) override {}
  void end() noexcept override {}
};

}  // namespace lacuna
