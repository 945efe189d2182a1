#include "engine/track/confidence.hpp"

#include "engine/simd/maths.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna {

double log_odds(const TrackEvidence& e) {
  constexpr double kMostOctaves = 2;  // more say nothing more
  return 10.93 * e.surface * e.best - 1.36 * e.surface * e.surface / (e.compactness + 0.1) +
         0.98 * std::min(e.persistence, kMostOctaves) - 7.71 * e.sampling_gap - 0.25;
}

double probability_of(double log_odds) {
  const double tail = exponential(-std::abs(log_odds));
  return (log_odds < 0 ? tail : 1) / (1 + tail);
}

}  // namespace lacuna
