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

namespace {

// What each number of the evidence adds to the log-odds. All but the surface share count in octaves.
struct Coefficients {
  double surface, width, compactness, prominence, persistence, sampling_gap, constant;
};

// Fitted by bench/accuracy/calibrate.py, each kind of loop apart. The constant of outer curves is 0.3 less
// than the fit's: most of those that the fit calls 0.5 sure on lidar scans are false.
constexpr Coefficients kOfHole{.surface = 9.3,
                               .width = 3.1,
                               .compactness = 1.4,
                               .prominence = 1.4,
                               .persistence = 0.7,
                               .sampling_gap = -7.4,
                               .constant = -16.4};
constexpr Coefficients kOfOuter{.surface = 3.6,
                                .width = 1.9,
                                .compactness = 0.7,
                                .prominence = 0,
                                .persistence = 1.1,
                                .sampling_gap = -3.2,
                                .constant = -6.4};

constexpr double kMostProminent = 32, kMostOctaves = 2;

double octaves_within(double ratio, double least, double most) {
  return octaves(std::clamp(ratio, least, most));
}

}  // namespace

double log_odds(const LoopEvidence& e) {
  const Coefficients& of = e.kind == LoopKind::kHole ? kOfHole : kOfOuter;
  // Beyond these, a number says nothing more.
  return of.surface * e.surface + of.width * octaves_within(e.width, 0.5, 5) +
         of.compactness * octaves_within(e.compactness, 1. / 16, 1) +
         of.prominence * octaves_within(e.prominence, 1, kMostProminent) +
         of.persistence * std::min(e.persistence, kMostOctaves) +
         of.sampling_gap * octaves_within(e.sampling_gap, 0.25, 1) + of.constant;
}

bool could_be_probable(LoopEvidence evidence) {
  evidence.prominence = kMostProminent;
  evidence.persistence = kMostOctaves;
  return log_odds(evidence) > 0;
}

bool could_be_tracked(LoopEvidence evidence) {
  constexpr double kNoChance = -4;
  evidence.persistence = kMostOctaves;
  return log_odds(evidence) > kNoChance;
}

double probability_of(double log_odds) {
  const double tail = exponential(-std::abs(log_odds));
  return (log_odds < 0 ? tail : 1) / (1 + tail);
}

}  // namespace lacuna
