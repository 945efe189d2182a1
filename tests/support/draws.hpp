// SPDX-License-Identifier: Apache-2.0
// Slow tests that draw many cases draw fewer where LACUNA_DRAWN_SHARE is set, by `tools/check.sh`.
#pragma once

#include "tests/support/test.hpp"

namespace lacuna {

// Returns this share of `cases`, at least one; all where LACUNA_DRAWN_SHARE is not set.
inline std::uint64_t draws(std::uint64_t cases) {
  const char* share = std::getenv("LACUNA_DRAWN_SHARE");
  const double some = share ? std::strtod(share, nullptr) * double(cases) : double(cases);
  return std::clamp<std::uint64_t>(some > 0 ? std::uint64_t(some) : 0, 1, cases);
}

}  // namespace lacuna
