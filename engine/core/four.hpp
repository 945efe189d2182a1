// Numbers of four points, read point by point and turned so that they stand side by side. For *.lanes.cpp
// (core/lanes): registers of four numbers whatever the instruction set.
#pragma once

#include "engine/core/lanes.hpp"

namespace lacuna {
inline namespace LACUNA_LANES {

inline constexpr std::size_t kFour = 4;
using Four = double __attribute__((vector_size(kFour * sizeof(double))));
using FourBits = std::int64_t __attribute__((vector_size(sizeof(Four))));

struct Turned {
  Four x, y, z, w;
};

// From x, y, z and w of each point.
LACUNA_INLINE Turned turn(const Four (&points)[kFour]) {
  const Four xz01 = __builtin_shufflevector(points[0], points[1], 0, 4, 2, 6);
  const Four yw01 = __builtin_shufflevector(points[0], points[1], 1, 5, 3, 7);
  const Four xz23 = __builtin_shufflevector(points[2], points[3], 0, 4, 2, 6);
  const Four yw23 = __builtin_shufflevector(points[2], points[3], 1, 5, 3, 7);
  return {__builtin_shufflevector(xz01, xz23, 0, 1, 4, 5), __builtin_shufflevector(yw01, yw23, 0, 1, 4, 5),
          __builtin_shufflevector(xz01, xz23, 2, 3, 6, 7), __builtin_shufflevector(yw01, yw23, 2, 3, 6, 7)};
}

struct TurnedPositions {
  Four x, y, z;
};

// Of points of three numbers each, and none beyond the last one's.
LACUNA_INLINE TurnedPositions load_turned(const double* const (&points)[kFour]) {
  using Two = double __attribute__((vector_size(sizeof(Four) / 2)));
  const auto x_and_y = [&](std::size_t a, std::size_t b) {
    return __builtin_shufflevector(load_as<Two>(points[a]), load_as<Two>(points[b]), 0, 1, 2, 3);
  };
  const Four xy02 = x_and_y(0, 2), xy13 = x_and_y(1, 3);
  return {__builtin_shufflevector(xy02, xy13, 0, 4, 2, 6), __builtin_shufflevector(xy02, xy13, 1, 5, 3, 7),
          Four{points[0][2], points[1][2], points[2][2], points[3][2]}};
}

}  // namespace LACUNA_LANES
}  // namespace lacuna
