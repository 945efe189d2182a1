// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/confidence.hpp"

#include "engine/simd/maths.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna {
namespace {

// Returns the logarithm to the base 2, by straight lines between powers of two: within 0.09, and the same on
// every machine.
double octaves(double ratio) {
  const int power = std::ilogb(ratio);
  return power + std::ldexp(ratio, -power) - 1;
}

}  // namespace

// Fitted by bench/accuracy/calibrate.py.
double log_odds(const LoopEvidence& e) {
  // Beyond these, a number says nothing more.
  constexpr double kClear = 0.7, kEmpty = 0.8, kNarrowest = 0.5, kWidest = 8;
  constexpr double kOfEmptiness = 20;  // not fitted: hardly any true loop is less empty than kEmpty
  const double clearness = std::min(e.clearness, kClear);
  const double width = octaves(std::clamp(e.width, kNarrowest, kWidest));
  return 14.6 * clearness + 9.5 * e.surface + 4.2 * e.roundness + 1.4 * width - 12.7 * e.sampling_gap - 15.8 +
         kOfEmptiness * (std::min(e.emptiness, kEmpty) - kEmpty);
}

double probability_of(double log_odds) {
  const double tail = exponential(-std::abs(log_odds));
  return (log_odds < 0 ? tail : 1) / (1 + tail);
}

}  // namespace lacuna
