// Tests that draw many cases and take long draw fewer where LACUNA_DRAWN_SHARE says so: `tools/check.sh --sanitize`.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace lacuna {

// LACUNA_DRAWN_SHARE of `cases`, at least one; all where it is not set.
inline std::uint64_t draws(std::uint64_t cases) {
  const char* share = std::getenv("LACUNA_DRAWN_SHARE");
  const double some = share ? std::strtod(share, nullptr) * double(cases) : double(cases);
  return std::clamp<std::uint64_t>(some > 0 ? std::uint64_t(some) : 0, 1, cases);
}

}  // namespace lacuna
