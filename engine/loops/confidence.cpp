// SPDX-License-Identifier: Apache-2.0
#include "engine/loops/confidence.hpp"

#include "engine/simd/maths.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna {

double octaves(double ratio) {
  const int power = std::ilogb(ratio);
  return power + std::ldexp(ratio, -power) - 1;
}

// Fitted by bench/accuracy/calibrate.py. The constant is 0.4 larger than the fit's: on meshes and real scans,
// most loops of a fitted confidence of 0.4 are true.
double log_odds(const LoopEvidence& e) {
  // Beyond these, a number says nothing more.
  constexpr double kClear = 0.7, kEmpty = 0.8, kNarrowest = 0.5, kWidest = 8, kMostOctaves = 2;
  constexpr double kOfEmptiness = 20;  // not fitted: hardly any true loop is less empty than kEmpty
  const double clearness = std::min(e.clearness, kClear);
  const double width = octaves(std::clamp(e.width, kNarrowest, kWidest));
  const double persistence = std::min(e.persistence, kMostOctaves);
  return 12.4 * clearness + 9.3 * e.surface + 4.1 * e.roundness + width + 0.8 * persistence -
         12.4 * e.sampling_gap - 13.7 + kOfEmptiness * (std::min(e.emptiness, kEmpty) - kEmpty);
}

double probability_of(double log_odds) {
  const double tail = exponential(-std::abs(log_odds));
  return (log_odds < 0 ? tail : 1) / (1 + tail);
}

}  // namespace lacuna
