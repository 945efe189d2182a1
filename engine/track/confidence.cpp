// SPDX-License-Identifier: Apache-2.0
#include "engine/track/confidence.hpp"

#include "engine/simd/maths.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacuna {
namespace {

// The evidence of all levels. Fitted by bench/accuracy/calibrate.py.
double tracked(const TrackEvidence& e) {
  constexpr double kMostOctaves = 2;  // more say nothing more
  return 11.24 * e.surface * e.best - 1.84 * e.surface * e.surface / (e.roundness + 0.1) +
         0.93 * std::min(e.persistence, kMostOctaves) - 7.44 * e.sampling_gap - 0.4;
}

// A small hole cannot persist. So at the first level its own loop may be evidence enough. Its weight grows
// with the evenness of the sampling.
bool may_say_enough(const TrackEvidence& e) {
  constexpr double kWidest = 8, kLeastRound = 0.2;
  return e.is_first_level && e.width <= kWidest && e.roundness >= kLeastRound;
}
double at_first_level(const TrackEvidence& e) {
  constexpr double kEven = 0.84, kMiddle = 0.65, kRise = 2, kSlope = 25, kMost = 2;
  const double middle = kMiddle + kRise * std::max(0.0, kEven - e.surface);
  return std::min(kSlope * (e.clearness - middle), kMost);
}

}  // namespace

double roundness(double perimeter, double area, double width) {
  constexpr double kMostOfLong = 0.5, kWidth = 8;
  const double compactness = 4 * std::numbers::pi * (area / perimeter) / perimeter;
  return std::max(compactness, kMostOfLong * std::min(1.0, width / kWidth));
}

double log_odds(const TrackEvidence& evidence) {
  return may_say_enough(evidence) ? std::max(tracked(evidence), at_first_level(evidence)) : tracked(evidence);
}

double probability_of(double log_odds) {
  const double tail = exponential(-std::abs(log_odds));
  return (log_odds < 0 ? tail : 1) / (1 + tail);
}

}  // namespace lacuna
