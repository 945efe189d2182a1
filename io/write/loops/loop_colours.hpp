// SPDX-License-Identifier: Apache-2.0
// The colours of loops in every result that has colours. Both have a contrast of 3.8 and more with white and
// of 5.4 and more with black, and differ for the colour-blind: orange and blue.
#pragma once

#include "engine/model/loop.hpp"

#include <cstdint>

namespace lacuna::io {

struct LoopColour {
  std::uint8_t red, green, blue;
};

inline constexpr LoopColour kHoleColour{230, 80, 30};
inline constexpr LoopColour kOuterColour{30, 130, 230};

constexpr const LoopColour& colour_of(LoopKind kind) {
  return kind == LoopKind::kHole ? kHoleColour : kOuterColour;
}

}  // namespace lacuna::io
