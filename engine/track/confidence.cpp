#include "engine/track/confidence.hpp"

#include "engine/simd/maths.hpp"

#include <algorithm>
#include <cmath>

namespace lacuna {
namespace {

// What all levels say. Fitted by bench/accuracy/calibrate.py.
double tracked(const TrackEvidence& e) {
  constexpr double kMostOctaves = 2;  // more say nothing more
  return 10.93 * e.surface * e.best - 1.36 * e.surface * e.surface / (e.compactness + 0.1) +
         0.98 * std::min(e.persistence, kMostOctaves) - 7.71 * e.sampling_gap - 0.25;
}

// Where sampling is even at the first level, its own loop says enough: a small hole cannot persist.
bool is_even(const TrackEvidence& e) {
  constexpr double kEven = 0.84, kCompact = 0.2;
  return e.is_first_level && e.surface >= kEven && e.compactness >= kCompact;
}
double evenly_sampled(const TrackEvidence& e) {
  constexpr double kMiddle = 0.65, kSlope = 25, kMost = 2;
  return std::min(kSlope * (e.clearness - kMiddle), kMost);
}

}  // namespace

double log_odds(const TrackEvidence& evidence) {
  return is_even(evidence) ? std::max(tracked(evidence), evenly_sampled(evidence)) : tracked(evidence);
}

double probability_of(double log_odds) {
  const double tail = exponential(-std::abs(log_odds));
  return (log_odds < 0 ? tail : 1) / (1 + tail);
}

}  // namespace lacuna
