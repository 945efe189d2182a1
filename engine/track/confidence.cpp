#include "engine/track/confidence.hpp"

#include "engine/simd/maths.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacuna {
namespace {

// What all levels say. Fitted by bench/accuracy/calibrate.py.
double tracked(const TrackEvidence& e) {
  constexpr double kMostOctaves = 2;  // more say nothing more
  return 11.34 * e.surface * e.best - 1.77 * e.surface * e.surface / (e.roundness + 0.1) +
         0.84 * std::min(e.persistence, kMostOctaves) - 7.44 * e.sampling_gap - 0.24;
}

// Where sampling is even at the first level, its own loop says enough: a small hole cannot persist.
bool is_even(const TrackEvidence& e) {
  constexpr double kEven = 0.84, kRound = 0.2;
  return e.is_first_level && e.surface >= kEven && e.roundness >= kRound;
}
double evenly_sampled(const TrackEvidence& e) {
  constexpr double kMiddle = 0.65, kSlope = 25, kMost = 2;
  return std::min(kSlope * (e.clearness - kMiddle), kMost);
}

}  // namespace

double roundness(double perimeter, double area, double spacing) {
  constexpr double kMostOfLong = 0.5, kWidth = 8;
  const double compactness = 4 * std::numbers::pi * (area / perimeter) / perimeter, width = 2 * area / perimeter;
  return std::max(compactness, kMostOfLong * std::min(1.0, width / spacing / kWidth));
}

double log_odds(const TrackEvidence& evidence) {
  return is_even(evidence) ? std::max(tracked(evidence), evenly_sampled(evidence)) : tracked(evidence);
}

double probability_of(double log_odds) {
  const double tail = exponential(-std::abs(log_odds));
  return (log_odds < 0 ? tail : 1) / (1 + tail);
}

}  // namespace lacuna
