// SPDX-License-Identifier: Apache-2.0
// mixed: bits that look random, from bits that do not. Source: SplitMix64 (Steele, Lea, Flood, 2014).
#pragma once

#include <cstdint>

namespace lacuna {

// Unlike numbers have unlike results. Each bit of the result depends on all bits given.
constexpr std::uint64_t mixed(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15;
  bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ bits >> 27) * 0x94d049bb133111eb;
  return bits ^ bits >> 31;
}

}  // namespace lacuna
