// SPDX-License-Identifier: Apache-2.0
// Sine and cosine of an angle in turns, from + - * and floor only. Unlike the C library's functions, they
// have the same bits on every machine.
#pragma once

#include <cmath>

namespace lacuna::synth {

inline constexpr double kTwoPi = 6.283185307179586;

struct SinCos {
  double sin, cos;
};

// Uses Taylor series within an eighth of a turn of the nearest quarter: error below 4e-16. |turns| < 2^50.
inline SinCos sin_cos(double turns) {
  const double quarter = std::floor(4 * turns + 0.5);
  const double x = kTwoPi * (turns - 0.25 * quarter);
  const double y = x * x;
  double s = -1.0 / 1307674368000;  // 1/15!
  double c = 1.0 / 20922789888000;  // 1/16!
  for (const double term :
       {1.0 / 6227020800, -1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6})
    s = s * y + term;
  for (const double term :
       {-1.0 / 87178291200, 1.0 / 479001600, -1.0 / 3628800, 1.0 / 40320, -1.0 / 720, 1.0 / 24, -1.0 / 2})
    c = c * y + term;
  const double sine = x + x * (y * s);
  const double cosine = 1 + y * c;
  switch (static_cast<long long>(quarter) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace lacuna::synth
