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

// What each number of the evidence adds to the log-odds. Shares count as they are, all else in octaves.
struct Coefficients {
  double surface, width, persistence, sampling_gap, constant;
  double compactness = 0, prominence = 0;                 // of holes
  double goes_on = 0, layers = 0, volume = 0, alike = 0;  // of outer curves
};

// Fitted by bench/accuracy/calibrate.py, each kind of loop apart. Outer curves then got values by hand: they
// are between fits in which loops rated by eye weigh little and much. Synthetic scans have few crowns, and no
// layers.
constexpr Coefficients kOfHole{.surface = 9.3,
                               .width = 3.1,
                               .persistence = 0.7,
                               .sampling_gap = -7.4,
                               .constant = -16.4,
                               .compactness = 1.4,
                               .prominence = 1.4};
constexpr Coefficients kOfOuter{.surface = 1.5,
                                .width = 2.3,
                                .persistence = 1,
                                .sampling_gap = -3.1,
                                .constant = -6,
                                .goes_on = -3.5,
                                .layers = -2.4,
                                .volume = -2.6,
                                .alike = -0.25};

constexpr double kMostProminent = 32, kMostOctaves = 2, kMostAlike = 256;

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
         of.sampling_gap * octaves_within(e.sampling_gap, 0.25, 1) + of.goes_on * e.beyond.goes_on +
         of.layers * e.beyond.layers + of.volume * e.beyond.volume +
         of.alike * octaves_within(1 + static_cast<double>(e.alike), 1, kMostAlike) + of.constant;
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
