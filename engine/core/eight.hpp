// Eight numbers side by side: a row of what is computed for eight points at once. A whole register of the
// widest instruction set, two or four of the others (core/lanes).
#pragma once

#include <cstddef>

namespace lacuna {

inline constexpr std::size_t kEight = 8;

struct alignas(64) Eight {
  double at[kEight];
};

struct alignas(32) EightSingles {
  float at[kEight];
};

// Sixteen of single precision: as large as eight.
inline constexpr std::size_t kSixteen = 16;

struct alignas(64) Sixteen {
  float at[kSixteen];
};

}  // namespace lacuna
