// SPDX-License-Identifier: Apache-2.0
// Sums and differences of coordinates modulo 2^32, since coordinates of damaged or far data may overflow.
#pragma once

#include <cstdint>

namespace lacuna::io::laz {

inline std::int32_t wrapped_sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

inline std::int32_t wrapped_difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

}  // namespace lacuna::io::laz
